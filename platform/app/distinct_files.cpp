#include "distinct_files.h"

#include <filesystem>
#include <system_error>
#include <vector>

namespace dicot::app {
namespace {

/// The one name of a file that may not exist yet; a device is nobody's copy.
std::string true_name(const std::string& name)
{
    std::error_code error;
    if (name.empty() || std::filesystem::is_character_file(name, error))
        return {};
    const std::filesystem::path path = std::filesystem::weakly_canonical(name, error);
    return error ? name : path.string();
}

} // namespace

Status check_distinct(std::initializer_list<std::string> inputs, std::initializer_list<std::string> outputs)
{
    std::vector<std::string> taken;
    for (const std::string& input : inputs)
        taken.push_back(true_name(input));
    for (const std::string& output : outputs) {
        const std::string name = true_name(output);
        for (const std::string& other : taken)
            if (!name.empty() && name == other)
                return failure(Fault::kUsage,
                               "%s is named twice: give every output a file of its own, and none of the inputs'",
                               output.c_str());
        taken.push_back(name);
    }
    return {};
}

} // namespace dicot::app
