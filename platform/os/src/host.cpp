#include "dicot/os/host.h"

#include "dicot/os/input_file.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <optional>

namespace dicot {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostSensors = 64;

/// The first line, printable; empty of a file that is not there.
std::string line_of(const fs::path& path)
{
    std::array<std::byte, 64> start{};
    InputFile file;
    const std::string name = path.string();
    if (!file.open(name.c_str()).ok())
        return "";
    const Result<std::size_t> size = file.read(start);
    std::string line{reinterpret_cast<const char*>(start.data()), size.ok() ? size.value() : 0};
    line.resize(std::min(line.find('\n'), line.size()));
    std::ranges::replace_if(
        line, [](char c) { return c < ' ' || c > '~'; }, '?');
    return line;
}

/// Thousandths of a degree, as both classes have it.
std::optional<double> celsius_in(const fs::path& path)
{
    const std::string text = line_of(path);
    int milli = 0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), milli);
    if (end.ec != std::errc{} || end.ptr != text.data() + text.size() || milli < -100'000 || milli > 300'000)
        return std::nullopt;
    return milli / 1000.0;
}

std::vector<fs::path> inside(const fs::path& folder)
{
    std::vector<fs::path> paths;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error); !error && entry != fs::directory_iterator{};
         entry.increment(error))
        paths.push_back(entry->path());
    std::ranges::sort(paths);
    return paths;
}

void add(std::vector<Temperature>& all, std::string name, const fs::path& path)
{
    const std::optional<double> celsius = celsius_in(path);
    if (!celsius || all.size() == kMostSensors)
        return;
    const auto taken = [&all](const std::string& wanted) {
        return std::ranges::any_of(all, [&](const Temperature& one) { return one.name == wanted; });
    };
    const std::string plain = name;
    for (int k = 2; taken(name); ++k)
        name = plain + " " + std::to_string(k);
    all.push_back({std::move(name), *celsius});
}

} // namespace

std::string host_name()
{
    std::array<char, 256> name{};
    return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

std::vector<Temperature> read_temperatures(const std::string& sys)
{
    std::vector<Temperature> all;
    for (const fs::path& zone : inside(sys + "/class/thermal"))
        if (const std::string type = line_of(zone / "type"); !type.empty())
            add(all, "thermal/" + type, zone / "temp");
    for (const fs::path& chip : inside(sys + "/class/hwmon"))
        for (const fs::path& input : inside(chip)) {
            const std::string file = input.filename().string();
            if (!file.starts_with("temp") || !file.ends_with("_input"))
                continue;
            const std::string sensor = file.substr(0, file.size() - 6);
            const std::string label = line_of(chip / (sensor + "_label"));
            add(all, "hwmon/" + line_of(chip / "name") + "/" + (label.empty() ? sensor : label), input);
        }
    return all;
}

} // namespace dicot
