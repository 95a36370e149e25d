#include "options.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

namespace dicot::usbip {

namespace {

constexpr int kLeastPayloadBytes = 64;
constexpr int kMaxPorts = 8;

std::optional<int> number_of(std::string_view text, int least, int most)
{
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size() || number < least || number > most)
        return std::nullopt;
    return number;
}

std::vector<std::string_view> parts_of(std::string_view text, char separator)
{
    std::vector<std::string_view> parts;
    while (true) {
        const std::size_t end = std::min(text.find(separator), text.size());
        parts.push_back(text.substr(0, end));
        if (end == text.size())
            return parts;
        text.remove_prefix(end + 1);
    }
}

bool take_rates(CameraModel& model, std::string_view value)
{
    model.rates_fps.clear();
    for (const std::string_view part : parts_of(value, '/'))
        if (const auto rate = number_of(part, 1, 240))
            model.rates_fps.push_back(*rate);
        else
            return false;
    return true;
}

// 192/1024/3x1024: packets a microframe x bytes.
bool take_alternates(CameraModel& model, std::string_view value)
{
    model.alternates.clear();
    for (std::string_view part : parts_of(value, '/')) {
        Alternate alternate;
        if (part.size() > 2 && part[1] == 'x') {
            const auto packets = number_of(part.substr(0, 1), 1, 3);
            if (!packets)
                return false;
            alternate.packets_a_microframe = *packets;
            part.remove_prefix(2);
        }
        const auto bytes = number_of(part, kLeastPayloadBytes, 1024);
        if (!bytes)
            return false;
        alternate.packet_bytes = *bytes;
        model.alternates.push_back(alternate);
    }
    return std::is_sorted(model.alternates.begin(), model.alternates.end(), [](const Alternate& a, const Alternate& b) {
        return a.bytes_a_microframe() < b.bytes_a_microframe();
    });
}

bool take_payload(CameraModel& model, std::string_view value)
{
    if (value == "fit" || value == "most") {
        model.payload_policy = value == "fit" ? PayloadPolicy::kFit : PayloadPolicy::kMost;
        return true;
    }
    const auto bytes = number_of(value, kLeastPayloadBytes, 1 << 20);
    model.payload_policy = PayloadPolicy::kFixed;
    model.payload_bytes = bytes.value_or(0);
    return bytes.has_value();
}

bool take(CameraWish& wish, std::string_view key, std::string_view value)
{
    CameraModel& model = wish.model;
    if (key == "name")
        model.name = value;
    else if (key == "frames")
        wish.frames = value;
    else if (key == "product")
        model.product = value;
    else if (key == "serial")
        model.serial = value;
    else if (key == "transfer" && (value == "iso" || value == "bulk"))
        model.bulk = value == "bulk";
    else if (key == "fps")
        return take_rates(model, value);
    else if (key == "alternates")
        return take_alternates(model, value);
    else if (key == "payload")
        return take_payload(model, value);
    else if (key == "port" && number_of(value, 0, kMaxPorts - 1))
        wish.port = *number_of(value, 0, kMaxPorts - 1);
    else
        return false;
    return true;
}

Result<CameraWish> camera_wish(std::string_view words, int number)
{
    CameraWish wish;
    wish.port = number;
    wish.model.name = "camera" + std::to_string(number);
    wish.model.product_id = static_cast<std::uint16_t>(number + 1);
    for (const std::string_view pair : parts_of(words, ',')) {
        const std::size_t equals = pair.find('=');
        if (equals == std::string_view::npos || !take(wish, pair.substr(0, equals), pair.substr(equals + 1)))
            return failure(Fault::kUsage, "--camera: '%s' is no key=value of README.md", std::string(pair).c_str());
    }
    if (wish.frames.empty())
        return failure(Fault::kUsage, "--camera: frames=FOLDER is missing");
    return wish;
}

// Plans and ports tell cameras apart by these.
Status distinct(const std::vector<CameraWish>& cameras)
{
    for (std::size_t i = 0; i < cameras.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (cameras[i].model.name == cameras[j].model.name || cameras[i].port == cameras[j].port)
                return failure(Fault::kUsage, "--camera: '%s' and '%s' need a name and a port each",
                               cameras[j].model.name.c_str(), cameras[i].model.name.c_str());
    return {};
}

} // namespace

Result<Options> read_options(std::span<const char* const> words)
{
    Options options;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string_view word = words[i];
        if (word == "--descriptors") {
            options.descriptors_only = true;
            continue;
        }
        if (i + 1 == words.size())
            return failure(Fault::kUsage, "'%s' is no option, or its value is missing; see README.md", words[i]);
        const std::string_view value = words[++i];
        if (word == "--camera") {
            options.cameras.push_back(TRY(camera_wish(value, static_cast<int>(options.cameras.size()))));
        } else if (word == "--bus-bytes" && number_of(value, 0, 1 << 20)) {
            options.bus_bytes = *number_of(value, 0, 1 << 20);
        } else if (word == "--plan") {
            options.plan = value;
        } else if (word == "--commands") {
            options.commands = value;
        } else {
            return failure(Fault::kUsage, "'%s %s' is no option; see README.md", words[i - 1], words[i]);
        }
    }
    if (options.cameras.empty())
        return failure(Fault::kUsage, "--camera frames=FOLDER is missing");
    TRY(distinct(options.cameras));
    return options;
}

} // namespace dicot::usbip
