// What the store's parts do to the medium, in sentences.
#pragma once

#include "folder_name.h"

#include "dicot/base/byte_sink.h"
#include "dicot/base/function_ref.h"
#include "dicot/base/status.h"
#include "dicot/medium/medium.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace dicot {

/// Fault::kIoError: what failed with which path, why, and the remedy.
Status card_failure(Errno why, const char* path, const char* doing);
/// The same, or ok.
Status on_card(Errno outcome, const char* path, const char* doing);

/// Of a file that was to be opened for reading: read_file() says which faults.
Status opened(Errno outcome, const char* path);

bool is_there(Medium& medium, const char* path);

/// The root is a board's folder in an archive.
bool is_archive(Medium& medium);

/// A file that is being written; closed, but not removed, when it is let go.
class CardFile final : public ByteSink
{
public:
    explicit CardFile(Medium& medium) : medium_(medium) {}
    CardFile(const CardFile&) = delete;
    CardFile& operator=(const CardFile&) = delete;
    ~CardFile() override;

    Status create(const StorePath& path);
    Status write(std::span<const std::byte> bytes) noexcept override;
    Status close();

private:
    Medium& medium_;
    StorePath path_;
    bool open_ = false;
    Medium::File file_ = 0;
};

/// A new file of these bytes.
Status write_file(Medium& medium, const StorePath& path, std::span<const std::byte> bytes);

/// From front to back, in pieces of at most `chunk`. Fault::kNoInput: it is not there; kBadData: it is no file, or
/// longer than `most_bytes`; kIoError: nobody can say.
Status read_file(Medium& medium, const StorePath& path, std::uint64_t most_bytes, std::span<std::byte> chunk,
                 FunctionRef<void(std::span<const std::byte>)> take);
/// All of it, which must fit. Errors as above.
Result<std::span<const std::byte>> read_whole(Medium& medium, const StorePath& path, std::span<std::byte> into);

/// Removes every file in a folder, then nothing more; a folder in it, or a name too long, is Fault::kBadData.
Status empty_folder(Medium& medium, const StorePath& folder);

/// Made if it is missing.
Status make_folder(Medium& medium, const StorePath& path);

} // namespace dicot
