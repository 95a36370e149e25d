#include "seen_picture.h"

#include "../take_picture.h"

#include "dicot/calibration/grey.h"
#include "dicot/os/memory_block.h"
#include "dicot/os/shown_path.h"
#include "dicot/picture/read_picture.h"

#include <algorithm>

namespace dicot::app {
namespace {

using calibration::Board;

struct GreyPicture
{
    MemoryBlock block;
    ImageView<const std::uint8_t> grey;
};

Result<GreyPicture> read_grey(const std::string& path)
{
    const PictureSize size = TRY(picture_size(path.c_str()));
    const auto lay_out = [&](Arena& arena) {
        return std::pair{take_picture<Rgb8>(arena, size.width, size.height),
                         take_picture<std::uint8_t>(arena, size.width, size.height)};
    };
    Arena measure;
    (void)lay_out(measure);
    GreyPicture picture{TRY(MemoryBlock::map(measure.peak())), {}};
    Arena arena(picture.block.bytes());
    const auto [colour, grey] = lay_out(arena);
    TRY(read_picture(path.c_str(), colour));
    calibration::to_grey(colour, grey);
    picture.grey = grey;
    return picture;
}

} // namespace

std::string shown_name(std::string name)
{
    for (char& c : name)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            c = '?';
    return name;
}

void SeenPicture::look(std::span<const Board> all)
{
    const auto picture = read_grey(path);
    if (!picture.ok()) {
        unreadable = picture.status().message();
        // The sentence begins with the path; who reads it knows the picture's name already.
        const std::string begin = std::string(shown_path(path.c_str())) + ": ";
        if (unreadable.starts_with(begin))
            unreadable.erase(0, begin.size());
        return;
    }
    for (std::size_t k = 0; k < boards.size(); ++k) {
        const Board& board = all[static_cast<std::size_t>(boards[k])];
        sights[k] = find_board(picture.value().grey, board);
        titles.push_back(std::to_string(board.cols) + " x " + std::to_string(board.rows));
    }
}

bool SeenPicture::any_found() const
{
    return std::any_of(sights.begin(), sights.end(), [](const auto& sight) { return sight.found; });
}

std::string SeenPicture::reason() const
{
    if (!unreadable.empty() || sights.size() == 1)
        return unreadable.empty() ? sights.front().reason : unreadable;
    std::string reasons;
    for (std::size_t k = 0; k < sights.size(); ++k)
        if (!sights[k].found)
            reasons += (reasons.empty() ? "board " : "; board ") + titles[k] + ": " + sights[k].reason;
    return reasons;
}

} // namespace dicot::app
