// What a board is called: the name of its folder among those of others.
#pragma once

#include <string>
#include <string_view>

namespace dicot::app {

/// Letters, digits, '.', '_' and '-', 63 at most, a letter or a digit first; and no date, as folders of days are named.
bool is_device_name(std::string_view text) noexcept;

/// The nearest such name: '-' for what may not be there; "dicot" if nothing is left.
std::string device_name_near(std::string_view host);

} // namespace dicot::app
