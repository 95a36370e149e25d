// One compressed archive of texts, as `tar tzf` reads it.
#pragma once

#include "dicot/base/status.h"
#include "dicot/os/output_file.h"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace dicot::app {

/// A .tar.gz: POSIX ustar (IEEE 1003.1, pax) through zlib. The same members give the same bytes. It appears with
/// commit(), or not at all (OutputFile). Takes memory from the heap.
class TarGz
{
public:
    TarGz();
    TarGz(const TarGz&) = delete;
    TarGz& operator=(const TarGz&) = delete;
    ~TarGz();

    /// `time_s`: since 1970, what all members bear. Errors: those of OutputFile::open(); Fault::kOsError: no memory.
    Status open(const char* path, std::int64_t time_s);
    /// A regular file, readable by all. Fault::kSoftware: `name` is empty, longer than kMostName, absolute or leads
    /// upwards; kIoError as for OutputFile::write().
    Status add(const std::string& name, std::string_view content);
    /// Errors: those of OutputFile::commit().
    Status commit();

    static constexpr std::size_t kMostName = 99;

private:
    struct Squeeze;
    Status put(std::string_view bytes, bool last = false);

    OutputFile file_;
    std::int64_t time_s_ = 0;
    std::unique_ptr<Squeeze> squeeze_;
};

} // namespace dicot::app
