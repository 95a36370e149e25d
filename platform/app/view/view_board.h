// The snapshots of one board, as dicot view reads them; nothing is written.
#pragma once

#include "../store/store_words.h"

#include "dicot/catalogue/catalogue.h"
#include "dicot/medium/medium.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace dicot::app {

class ViewBoard
{
public:
    /// The slots of a store or an archive as they are now; `last`: only so many, the newest. Errors:
    /// ReadStore::open()'s.
    static Result<ViewBoard> of_folder(const DeviceFolder& folder, std::optional<std::int64_t> last);
    /// A cloud file alone: a board of one slot. Errors: CloudOnDisk::read()'s.
    static Result<ViewBoard> of_cloud(const std::string& path);

    const std::string& name() const { return name_; }
    const std::vector<SlotRow>& slots() const { return slots_; } ///< ascending by sequence
    const SlotRow* find(std::int64_t sequence) const;            ///< null: there is none

    /// A file of a slot whose folder is here. Fault::kNoInput: it is not there; kBadData: larger than any file that
    /// dicot wrote; kIoError. No link is followed.
    Result<std::string> read(const SlotRow& row, const char* file) const;
    /// The slot as `dicot show` has it: slot, record and what became of each file.
    nlohmann::json snapshot_json(const SlotRow& row) const;
    /// sequence, time_s (null: not known), state (a letter each), reason (number of one of `reasons`, or -1).
    nlohmann::json slots_json() const;

private:
    std::string name_;
    std::string folder_; ///< empty: a cloud alone
    std::string cloud_;
    bool time_known_ = true;
    std::vector<SlotRow> slots_;
};

} // namespace dicot::app
