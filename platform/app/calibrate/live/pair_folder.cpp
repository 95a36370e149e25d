#include "pair_folder.h"

#include "../../output_folder.h"
#include "../pair_files.h"

#include "dicot/picture/write_picture.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <unistd.h>

namespace dicot::app {
namespace {

struct Names
{
    std::string left;
    std::string right;
};

Names names_of(const std::string& folder, int number)
{
    std::array<char, 16> digits{};
    std::snprintf(digits.data(), digits.size(), "%02d.png", number);
    return {folder + "/left" + digits.data(), folder + "/right" + digits.data()};
}

bool is_there(const std::string& path)
{
    return ::access(path.c_str(), F_OK) == 0;
}

} // namespace

Result<PairFolder> PairFolder::open(const std::string& path, bool resume)
{
    PairFolder folder;
    folder.path_ = path;
    folder.made_ = !is_there(path);
    TRY(make_folder(path));
    if (::access(path.c_str(), W_OK | X_OK) != 0)
        return failure(Fault::kCannotCreate, "%s: cannot be written into (%s): name another folder with --images",
                       path.c_str(), std::strerror(errno));
    std::error_code error;
    const bool empty = std::filesystem::is_empty(path, error);
    if (error)
        return failure(Fault::kCannotCreate, "%s: cannot be read (%s): name another folder with --images", path.c_str(),
                       error.message().c_str());
    if (empty)
        return folder;
    if (!resume)
        return failure(Fault::kCannotCreate,
                       "%s: is not empty: go on with its pairs with --resume, or name an empty folder with --images",
                       path.c_str());
    for (const PicturePair& pair : TRY(pairs_in_folder(path)).pairs)
        folder.earlier_.push_back({path + "/" + pair.left, path + "/" + pair.right});
    return folder;
}

Status PairFolder::add(ImageView<const Rgb8> left, ImageView<const Rgb8> right)
{
    Names names = names_of(path_, next_);
    while (is_there(names.left) || is_there(names.right))
        names = names_of(path_, ++next_);
    TRY(write_png(names.left.c_str(), left));
    if (const Status written = write_png(names.right.c_str(), right); !written.ok()) {
        (void)::unlink(names.left.c_str()); // alone it would be the next run's riddle
        return written;
    }
    ++next_;
    last_name_ = names.left.substr(names.left.rfind('/') + 1);
    return {};
}

void PairFolder::remove_if_empty() const
{
    if (made_)
        (void)::rmdir(path_.c_str());
}

std::string pairs_beside(const std::string& rig_path)
{
    const std::filesystem::path rig(rig_path);
    return (rig.parent_path() / (rig.stem().string() + "-pairs")).string();
}

} // namespace dicot::app
