// A place of the left picture, found again in the right one to a fraction of a pixel.
#pragma once

#include "grey.h"

#include <optional>

namespace dicot::drift {

/// None: it is not found, or not surely.
std::optional<Sight> refind(Grey left, Grey right, const Place& place) noexcept;

} // namespace dicot::drift
