// The conversation with one device, which all sources on it share.
#pragma once

#include "dicot/base/function_ref.h"
#include "dicot/mtp_host/initiator.h"
#include "dicot/pull_archive/pull_source.h"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace dicot::app {

class DeviceTalk
{
public:
    static constexpr std::size_t kMostInSnapshot = 64;                ///< objects in a snapshot's folder
    static constexpr std::size_t kMostOffered = std::size_t{1} << 20; ///< snapshots of one board
    static constexpr std::size_t kMostLooks = std::size_t{1} << 21;   ///< objects that one question may cost

    DeviceTalk(std::unique_ptr<mtp::UsbPipe> pipe, const mtp::MtpListed& listed,
               const mtp::Initiator::Patience& patience);
    DeviceTalk(const DeviceTalk&) = delete;
    DeviceTalk& operator=(const DeviceTalk&) = delete;
    ~DeviceTalk() { initiator_.close(); }

    Status open();

    mtp::Initiator& initiator() noexcept { return initiator_; }
    std::string_view serial() const noexcept { return serial_; }
    std::string_view where() const noexcept { return where_; }

    /// A question of the puller begins: see kMostLooks.
    void begin_question() noexcept { looks_ = 0; }
    /// What stands in a folder, and what each one is, until `visit` returns false; what goes away meanwhile is passed
    /// over. Fault::kBadData: more than `most`.
    Status for_each_in(std::uint32_t storage, std::uint32_t folder, bool folders_alone, std::size_t most,
                       FunctionRef<bool(std::uint32_t, const mtp::ObjectFacts&)> visit);
    /// The files of a snapshot's folder that may belong to it, as PullSource::files() has them.
    Status files_in(std::uint32_t storage, std::uint32_t folder, FunctionRef<bool(const OfferedFile&)> visit);

private:
    std::unique_ptr<mtp::UsbPipe> pipe_;
    mtp::Initiator initiator_;
    std::string serial_, where_;
    std::size_t looks_ = 0;
};

} // namespace dicot::app
