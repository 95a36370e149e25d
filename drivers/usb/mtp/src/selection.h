#pragma once

#include "dicot/mtp/responder.h"

namespace dicot::mtp {

/// What GetNumObjects and GetObjectHandles ask for.
struct Responder::Selection
{
    std::uint32_t storage = kEvery;
    std::uint32_t format = 0;     ///< 0: any; kEvery: pictures
    std::uint32_t parent = kRoot; ///< 0: everything; kTop: what stands at the top

    explicit Selection(const Block& command) noexcept
        : storage(command.parameters[0]), format(command.parameters[1]), parent(command.parameters[2])
    {
    }
};

} // namespace dicot::mtp
