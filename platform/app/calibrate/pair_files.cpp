#include "pair_files.h"

#include "picture_name.h"

#include "dicot/os/shown_path.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <dirent.h>
#include <memory>
#include <sys/stat.h>
#include <tuple>

namespace dicot::app {
namespace {

struct Candidate
{
    PictureName said;
    const std::string* name = nullptr;
};

/// The first two, one of each side, that `same` calls equal; both lists are sorted accordingly. Ends where there are
/// none.
template <typename Iterator, typename Less>
std::pair<Iterator, Iterator> first_common(Iterator left, Iterator left_end, Iterator right, Iterator right_end,
                                           Less less)
{
    while (left != left_end && right != right_end) {
        if (less(*left, *right))
            ++left;
        else if (less(*right, *left))
            ++right;
        else
            return {left, right};
    }
    return {left_end, right_end};
}

/// Pairs what one number has on both sides: at most one pair.
void pair_group(std::vector<Candidate>& lefts, std::vector<Candidate>& rights, PairedNames& result)
{
    const auto leave = [&](const Candidate& c, std::string reason) {
        result.alone.push_back({*c.name, std::move(reason)});
    };
    if (lefts.empty() || rights.empty()) {
        for (const Candidate& c : lefts)
            leave(c, "no right picture of this number");
        for (const Candidate& c : rights)
            leave(c, "no left picture of this number");
        return;
    }
    // PNG before JPEG among equals; then equal spellings with two endings; then what is the only one of its number.
    const auto by_ending = [](const Candidate& a, const Candidate& b) {
        return std::tie(a.said.ending, a.said.spelling, *a.name) < std::tie(b.said.ending, b.said.spelling, *b.name);
    };
    std::sort(lefts.begin(), lefts.end(), by_ending);
    std::sort(rights.begin(), rights.end(), by_ending);
    auto [left, right] =
        first_common(lefts.begin(), lefts.end(), rights.begin(), rights.end(), [](const auto& a, const auto& b) {
            return std::tie(a.said.ending, a.said.spelling) < std::tie(b.said.ending, b.said.spelling);
        });
    if (left == lefts.end()) {
        const auto by_spelling = [](const Candidate& a, const Candidate& b) {
            return std::tie(a.said.spelling, a.said.ending, *a.name) <
                   std::tie(b.said.spelling, b.said.ending, *b.name);
        };
        std::sort(lefts.begin(), lefts.end(), by_spelling);
        std::sort(rights.begin(), rights.end(), by_spelling);
        std::tie(left, right) =
            first_common(lefts.begin(), lefts.end(), rights.begin(), rights.end(),
                         [](const auto& a, const auto& b) { return a.said.spelling < b.said.spelling; });
    }
    if (left == lefts.end() && lefts.size() == 1 && rights.size() == 1)
        left = lefts.begin(), right = rights.begin();
    if (left == lefts.end()) {
        for (const auto* side : {&lefts, &rights})
            for (const Candidate& c : *side)
                leave(c, "several pictures have this number, and none is spelled like one of the other side");
        return;
    }
    result.pairs.push_back({*left->name, *right->name});
    for (const auto& [side, chosen] : {std::pair{&lefts, left}, std::pair{&rights, right}})
        for (auto c = side->begin(); c != side->end(); ++c)
            if (c != chosen)
                leave(*c, *chosen->name + " has the same number");
}

struct FolderContent
{
    std::vector<std::string> pictures;
    std::vector<std::string> folders;
};

Result<FolderContent> content_of(const std::string& folder)
{
    const std::unique_ptr<DIR, int (*)(DIR*)> opened(::opendir(folder.c_str()), [](DIR* d) { return ::closedir(d); });
    if (!opened)
        return failure(Fault::kNoInput, "%s: %s: name a folder of pictures", shown_path(folder.c_str()),
                       errno == ENOTDIR ? "is no folder" : std::strerror(errno));
    FolderContent content;
    for (;;) {
        errno = 0;
        const dirent* entry = ::readdir(opened.get());
        if (entry == nullptr)
            break;
        const std::string name = entry->d_name;
        struct stat there
        {
        };
        if (name.front() == '.' || ::stat((folder + "/" + name).c_str(), &there) != 0)
            continue; // hidden, or a link to nothing
        if (S_ISDIR(there.st_mode))
            content.folders.push_back(name);
        else if (S_ISREG(there.st_mode) && is_picture(name))
            content.pictures.push_back(name);
    }
    if (errno != 0)
        return failure(Fault::kNoInput, "%s: cannot be read to its end: %s", shown_path(folder.c_str()),
                       std::strerror(errno));
    return content;
}

/// Whether a folder is called after a side and nothing else.
bool is_side_folder(const std::string& name, CameraNumbers numbers)
{
    const PictureName said = read_name(name + "/x.png", numbers);
    const std::string low = said.spelling.substr(0, said.spelling.find('/'));
    return (said.side == Side::kLeft || said.side == Side::kRight) &&
           (low.size() == 1 || low.starts_with("cam") || low.starts_with("image"));
}

CameraNumbers numbering(std::span<const std::string> names)
{
    const bool zero = std::any_of(names.begin(), names.end(), [](const auto& name) { return names_camera(name, 0); });
    const bool two = std::any_of(names.begin(), names.end(), [](const auto& name) { return names_camera(name, 2); });
    return two && !zero ? CameraNumbers::kFromOne : CameraNumbers::kFromZero;
}

Status why_no_pair(const std::string& folder, const PairedNames& names, bool has_folders)
{
    const char* path = shown_path(folder.c_str());
    if (names.alone.empty())
        return failure(Fault::kNoInput, "%s: no PNG, JPEG or PPM pictures in it%s", path,
                       has_folders
                           ? "; folders in it are looked into only if they are called left and right: name each "
                             "one with --images"
                           : "");
    if (names.lefts > 0 && names.rights == 0)
        return failure(Fault::kNoInput,
                       "%s: %d pictures of the left camera and none of the right one: both are needed, as left01.jpg "
                       "and right01.jpg, or in folders left and right of one folder that --images names",
                       path, names.lefts);
    if (names.rights > 0 && names.lefts == 0)
        return failure(Fault::kNoInput,
                       "%s: %d pictures of the right camera and none of the left one: both are needed, as left01.jpg "
                       "and right01.jpg, or in folders left and right of one folder that --images names",
                       path, names.rights);
    return failure(Fault::kNoInput,
                   "%s: no pair among %zu pictures (%.60s: %.100s): name them left01.jpg and right01.jpg, or "
                   "give the folder that holds the folders left and right",
                   path, names.alone.size(), names.alone.front().name.c_str(), names.alone.front().reason.c_str());
}

} // namespace

PairedNames pair_names(std::span<const std::string> names)
{
    const CameraNumbers numbers = numbering(names);
    PairedNames result;
    std::vector<Candidate> sided;
    for (const std::string& name : names) {
        Candidate c{read_name(name, numbers), &name};
        result.lefts += c.said.side == Side::kLeft ? 1 : 0;
        result.rights += c.said.side == Side::kRight ? 1 : 0;
        if (c.said.side == Side::kLeft || c.said.side == Side::kRight)
            sided.push_back(std::move(c));
        else
            result.alone.push_back({name, c.said.side == Side::kNone ? "its name says neither left nor right"
                                                                     : "its name says both left and right"});
    }
    std::sort(sided.begin(), sided.end(),
              [](const Candidate& a, const Candidate& b) { return a.said.number < b.said.number; });
    for (auto group = sided.begin(); group != sided.end();) {
        const auto end =
            std::find_if(group, sided.end(), [&](const Candidate& c) { return c.said.number != group->said.number; });
        std::vector<Candidate> lefts;
        std::vector<Candidate> rights;
        for (; group != end; ++group)
            (group->said.side == Side::kLeft ? lefts : rights).push_back(std::move(*group));
        pair_group(lefts, rights, result);
    }
    std::sort(result.pairs.begin(), result.pairs.end(),
              [](const PicturePair& a, const PicturePair& b) { return before(a.left, b.left); });
    std::sort(result.alone.begin(), result.alone.end(),
              [](const LonePicture& a, const LonePicture& b) { return before(a.name, b.name); });
    return result;
}

Result<PairedNames> pairs_in_folder(const std::string& folder)
{
    FolderContent content = TRY(content_of(folder));
    PairedNames names = pair_names(content.pictures);
    if (!names.pairs.empty())
        return names;
    std::vector<std::string> below;
    const CameraNumbers numbers = numbering(content.folders);
    for (const std::string& side : content.folders)
        if (is_side_folder(side, numbers))
            for (const std::string& name : TRY(content_of(folder + "/" + side)).pictures)
                below.push_back(side + "/" + name);
    if (!below.empty())
        names = pair_names(below);
    if (names.pairs.empty())
        return why_no_pair(folder, names, !content.folders.empty());
    return names;
}

} // namespace dicot::app
