// "writing" in the store's folder: while it is there, folders may have no row yet.
#pragma once

#include "dicot/base/status.h"
#include "dicot/medium/medium.h"

namespace dicot {

class WritingMark
{
public:
    explicit WritingMark(Medium& medium) : medium_(medium) {}

    /// Whether an earlier process left it, or that cannot be told. A card that is too full for it is no reason not to
    /// start: pruning may help.
    bool put();
    /// No snapshot may come to its place without it.
    Status make_sure();
    void remove();

private:
    Errno try_to_put();

    Medium& medium_;
    Errno last_ = 0;
};

} // namespace dicot
