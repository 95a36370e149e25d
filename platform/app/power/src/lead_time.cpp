#include "dicot/power/lead_time.h"

#include "dicot/os/input_file.h"
#include "dicot/os/output_file.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <span>

namespace dicot::app {
namespace {

constexpr std::array<std::string_view, kLeadParts> kNames{"cameras", "resume", "boot"};
constexpr std::int64_t kSecondUs = 1'000'000;

} // namespace

void LeadTime::add(Times& times, std::int64_t took_us) noexcept
{
    times.us[times.next] = std::min(took_us, kMostUs);
    times.next = (times.next + 1) % kKept;
    times.count = std::min(times.count + 1, kKept);
}

std::int64_t LeadTime::of(LeadPart part) const noexcept
{
    const auto place = static_cast<std::size_t>(part);
    const Times& times = parts_[place];
    if (times.count == 0)
        return kDefaultUs[place];
    const std::int64_t longest = *std::max_element(times.us.begin(), times.us.begin() + static_cast<long>(times.count));
    return std::min(longest + longest / 4 + kSecondUs, kMostUs);
}

void LeadTime::open(const char* state) noexcept
{
    if (*state == '\0')
        return;
    char path[256];
    const int length = std::snprintf(path, sizeof path, "%s/lead", state);
    if (length < 0 || static_cast<std::size_t>(length) >= sizeof path)
        return;
    file_ = path;
    InputFile file;
    char bytes[400];
    if (!file.open(path).ok())
        return;
    const Result<std::size_t> count = file.read(std::as_writable_bytes(std::span{bytes}));
    if (count.ok())
        parse({bytes, count.value()});
    for (std::size_t part = 0; part < kLeadParts; ++part)
        kept_us_[part] = of(static_cast<LeadPart>(part));
}

Status LeadTime::note(LeadPart part, std::int64_t took_us) noexcept
{
    if (took_us < 0)
        return {};
    const auto place = static_cast<std::size_t>(part);
    add(parts_[place], took_us);
    const std::int64_t lead_us = of(part);
    if (file_.empty() || std::abs(lead_us - kept_us_[place]) < kSecondUs)
        return {};
    OutputFile file;
    const ShortText<400> words = text();
    TRY(file.open(file_.c_str()));
    TRY(file.write(words.c_str(), words.view().size()));
    TRY(file.commit());
    kept_us_[place] = lead_us;
    return {};
}

ShortText<400> LeadTime::text() const noexcept
{
    char words[401];
    std::size_t size = 0;
    const auto add_words = [&](int length) { size += static_cast<std::size_t>(std::max(length, 0)); };
    for (std::size_t part = 0; part < kLeadParts; ++part) {
        const Times& times = parts_[part];
        add_words(std::snprintf(words + size, sizeof words - size, "%s_ms", kNames[part].data()));
        for (std::size_t i = 0; i < times.count; ++i) {
            const std::size_t oldest_first = (times.next + kKept - times.count + i) % kKept;
            add_words(std::snprintf(words + size, sizeof words - size, " %lld",
                                    static_cast<long long>(times.us[oldest_first] / 1000)));
        }
        add_words(std::snprintf(words + size, sizeof words - size, "\n"));
    }
    return std::string_view{words, size};
}

void LeadTime::parse(std::string_view text) noexcept
{
    parts_ = {};
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        const std::string_view name = line.substr(0, line.find(' '));
        const auto known = std::find_if(kNames.begin(), kNames.end(), [name](std::string_view part) {
            return name.size() == part.size() + 3 && name.starts_with(part) && name.ends_with("_ms");
        });
        if (known == kNames.end())
            continue;
        Times& times = parts_[static_cast<std::size_t>(known - kNames.begin())];
        while (true) {
            const std::size_t blank = line.find(' ');
            if (blank == std::string_view::npos)
                break;
            line.remove_prefix(blank + 1);
            const std::string_view word = line.substr(0, line.find(' '));
            std::int64_t ms = -1;
            const auto [stopped, error] = std::from_chars(word.data(), word.data() + word.size(), ms);
            if (error == std::errc{} && stopped == word.data() + word.size() && ms >= 0 && ms <= kMostUs / 1000)
                add(times, ms * 1000);
        }
    }
}

} // namespace dicot::app
