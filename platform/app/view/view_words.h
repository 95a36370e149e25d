// The words of dicot view, the same whether the program has the viewer or not.
#pragma once

#include "../command.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace dicot::app {

struct ViewWords
{
    std::string path;
    std::string places;        ///< of the plants; empty: they are told apart by the gaps between them
    std::string export_folder; ///< empty: serve
    std::optional<std::int64_t> last;
    int port = 0;
    bool no_open = false;
};

void add_view_words(CLI::App& program, Command& chosen, const std::function<Status(const ViewWords&)>& run);

} // namespace dicot::app
