#include "dicot/store/sums.h"

#include "folder_name.h"

#include <algorithm>
#include <cstdio>

namespace dicot {
namespace {

constexpr std::size_t kDigits = 64;

bool is_digest(std::string_view text)
{
    return text.size() == kDigits && std::all_of(text.begin(), text.end(), [](char c) {
               return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
           });
}

} // namespace

const Sum* Sums::find(std::string_view name) const
{
    const auto files_here = all();
    const auto* const at = std::find_if(files_here.data(), files_here.data() + files_here.size(),
                                        [&](const Sum& sum) { return sum.name.view() == name; });
    return at == files_here.data() + files_here.size() ? nullptr : at;
}

bool Sums::add(std::string_view name, std::string_view sha256)
{
    if (count == kMaxSums || find(name) != nullptr)
        return false;
    files[static_cast<std::size_t>(count++)] = {name, sha256};
    return true;
}

Result<Sums> parse_sums(std::string_view text)
{
    Sums sums;
    for (int line = 1; !text.empty(); ++line) {
        const std::size_t end = text.find('\n');
        if (end == std::string_view::npos)
            return failure(Fault::kBadData, "line %d has no end", line);
        const std::string_view words = text.substr(0, end);
        text.remove_prefix(end + 1);
        if (words.size() < kDigits + 3 || !is_digest(words.substr(0, kDigits)) || words.substr(kDigits, 2) != "  " ||
            !is_file_name(words.substr(kDigits + 2)))
            return failure(Fault::kBadData, "line %d is no digest and a file's name", line);
        if (!sums.add(words.substr(kDigits + 2), words.substr(0, kDigits)))
            return failure(Fault::kBadData, "line %d is one too many", line);
    }
    if (sums.find(kRecord) == nullptr || sums.find(kSums) != nullptr || sums.find(kPulledMark) != nullptr)
        return failure(Fault::kBadData, "these are not the files of a snapshot");
    return sums;
}

std::size_t print_sums(const Sums& sums, std::span<char> into)
{
    std::size_t used = 0;
    for (const Sum& sum : sums.all()) {
        const int length =
            std::snprintf(into.data() + used, into.size() - used, "%s  %s\n", sum.sha256.c_str(), sum.name.c_str());
        used = std::min(into.size(), used + static_cast<std::size_t>(std::max(length, 0)));
    }
    return used;
}

} // namespace dicot
