// The snapshot that is being written, until it stands in its place.
#pragma once

#include "card.h"
#include "dicot/store/sums.h"
#include "folder_name.h"

#include "dicot/base/function_ref.h"
#include "dicot/store/store.h"

#include <array>

namespace dicot {

class Incoming
{
public:
    explicit Incoming(Medium& medium) : medium_(medium) {}

    /// Makes the folder, and the number lasts when it returns.
    Status begin(const PartName& part);
    /// Takes up what another process left. A whole one is settled as it is.
    void adopt(const PartName& part, bool whole);
    bool begun() const { return begun_; }
    const StorePath& target() const { return target_; }

    Status add(const char* name, FunctionRef<Status(ByteSink&)> fill);
    void for_each_added(FunctionRef<void(const Store::Added&)> visit) const;
    Status take_back();

    /// What it came to, for the catalogue.
    struct Settled
    {
        ShortText<64> sums;
        std::int64_t bytes = 0;
    };
    /// The order of all that makes a snapshot durable stands here alone.
    Result<Settled> settle();

private:
    Status write_sums(Settled& settled);
    Status sync_files();
    Status prepare_day();
    Status move_into_place();
    Status sync_day();
    void move_back();

    void name_it(const PartName& part);

    Medium& medium_;
    bool begun_ = false;
    bool whole_ = false;
    StorePath part_, day_, target_;
    Sums sums_;
    std::array<std::uint64_t, kMaxSums> bytes_{};
};

} // namespace dicot
