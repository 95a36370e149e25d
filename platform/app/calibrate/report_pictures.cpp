#include "report_pictures.h"

#include "../match_words.h"
#include "../rectify_rig.h"
#include "report_text.h"

#include "dicot/os/shown_path.h"
#include "dicot/picture/read_picture.h"
#include "dicot/picture/write_picture.h"

#include <algorithm>
#include <cstdint>

namespace dicot::app {
namespace {

constexpr int kQuality = 82;
constexpr double kFullSquare_px = 16; // corners of smaller squares are drawn finer

struct Picture
{
    int width = 0;
    int height = 0;
    std::vector<Rgb8> pixels;

    Picture(int w, int h) : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
    ImageView<Rgb8> view() { return {pixels.data(), width, height}; }
};

/// The picture, which must have this size if one is given.
Result<Picture> picture_at(const std::string& path, int width = 0, int height = 0)
{
    const PictureSize size = TRY(picture_size(path.c_str()));
    if (width > 0 && (size.width != width || size.height != height))
        return failure(Fault::kBadData, "%s: has another size than the picture that the calibration saw",
                       shown_path(path.c_str()));
    Picture picture(size.width, size.height);
    TRY(read_picture(path.c_str(), picture.view()));
    return picture;
}

/// Along one axis: `small` pixels side by side cover `large` of the source. Lengths count in 1/small of a source pixel.
struct Cover
{
    int first, last;
    std::int64_t first_share, last_share, inner_share;

    Cover(int index, int small, int large)
    {
        const std::int64_t begin = std::int64_t{index} * large;
        const std::int64_t end = begin + large;
        first = static_cast<int>(begin / small);
        last = static_cast<int>((end - 1) / small);
        first_share = std::min<std::int64_t>(end, (std::int64_t{first} + 1) * small) - begin;
        last_share = first == last ? first_share : end - std::int64_t{last} * small;
        inner_share = small;
    }
    std::int64_t share(int pixel) const
    {
        return pixel == first ? first_share : pixel == last ? last_share : inner_share;
    }
};

/// The mean of what each small pixel covers, rounded.
void shrink(ImageView<const Rgb8> from, ImageView<Rgb8> into)
{
    const std::int64_t all = std::int64_t{from.width} * from.height;
    for (int y = 0; y < into.height; ++y) {
        const Cover rows(y, into.height, from.height);
        for (int x = 0; x < into.width; ++x) {
            const Cover cols(x, into.width, from.width);
            std::int64_t r = all / 2, g = all / 2, b = all / 2;
            for (int v = rows.first; v <= rows.last; ++v)
                for (int u = cols.first; u <= cols.last; ++u) {
                    const std::int64_t share = rows.share(v) * cols.share(u);
                    const Rgb8 pixel = from.at(u, v);
                    r += share * pixel.r;
                    g += share * pixel.g;
                    b += share * pixel.b;
                }
            into.at(x, y) = {static_cast<std::uint8_t>(r / all), static_cast<std::uint8_t>(g / all),
                             static_cast<std::uint8_t>(b / all)};
        }
    }
}

Result<ReportPicture> write_small(Picture& picture, int most_width, const std::string& folder, std::string file)
{
    ReportPicture written{std::move(file), "", std::min(most_width, picture.width), 0};
    written.height = std::max(1, static_cast<int>(std::int64_t{picture.height} * written.width / picture.width));
    Picture small(written.width, written.height);
    shrink(picture.view(), small.view());
    TRY(write_jpeg((folder + "/" + written.file).c_str(), small.view(), kQuality));
    return written;
}

ReportPicture missing(const Status& why)
{
    return {"", why.message(), 0, 0};
}

} // namespace

Result<PairPictures> write_thumbnails(const SeenPair& pair, std::size_t number, const std::string& folder)
{
    PairPictures both;
    for (const Eye eye : kEyes) {
        Result<Picture> picture = picture_at(eye == Eye::kLeft ? pair.left_path : pair.right_path);
        ReportPicture& small = eye == Eye::kLeft ? both.left : both.right;
        small = picture.ok() ? TRY(write_small(picture.value(), kThumbnailWidth, folder,
                                               fill("pair-{}-{}.jpg", {number, name_of(eye)})))
                             : missing(picture.status());
    }
    return both;
}

Result<PairPictures> write_rectified(const CalibrationRun& run, const SeenPair& pair, const std::string& folder)
{
    RigFile rig = run.rig;
    const Result<RectifyTables> tables = RectifyTables::build(rig, kCrop, "the calibration");
    if (!tables.ok())
        return PairPictures{missing(tables.status()), missing(tables.status())};
    const Kernels* kernels = TRY(choose_kernels("auto"));
    PairPictures both;
    for (const Eye eye : kEyes) {
        const bool left = eye == Eye::kLeft;
        ReportPicture& small = left ? both.left : both.right;
        Result<Picture> raw = picture_at(left ? pair.left_path : pair.right_path, rig.width, rig.height);
        if (!raw.ok()) {
            small = missing(raw.status());
            continue;
        }
        Picture flat(rig.width, rig.height);
        remap(left ? tables.value().left() : tables.value().right(), *kernels, raw.value().view(), flat.view(),
              tables.value().spans());
        small = TRY(write_small(flat, kRectifiedWidth, folder, fill("rectified-{}.jpg", {name_of(eye)})));
    }
    return both;
}

std::string corner_drawing(const ReportPicture& picture, const std::string& label, const CalibrationRun& run,
                           const calibration::BoardSight& sight, int board)
{
    if (picture.file.empty())
        return fill("<p class=\"lost\">The {} picture could not be read again: {}</p>\n",
                    {escaped(label), escaped(picture.missing)});
    const double scale = run.task.width > 0 ? static_cast<double>(picture.width) / run.task.width : 1;
    const double stroke = std::clamp(sight.square_px * scale / kFullSquare_px, 0.6, 1.0);
    std::string svg = fill(
        R"(<svg viewBox="0 0 {} {}" stroke-width="{}" role="img" aria-label="{}">)"
        R"(<image href="{}" width="{}" height="{}"/>)",
        {picture.width, picture.height, fixed(stroke, 2), escaped(label), picture.file, picture.width, picture.height});
    if (!sight.found || board < 0)
        return svg + "</svg>\n";
    const int cols = run.task.boards[static_cast<std::size_t>(board)].cols;
    const auto place = [&](const Point2& corner) {
        return fill("{},{} ", {fixed(scale * (corner.x + 0.5), 1), fixed(scale * (corner.y + 0.5), 1)});
    };
    const auto per_row = static_cast<std::size_t>(cols);
    for (std::size_t first = 0; first < sight.corners.size(); first += per_row) {
        // Each row's line starts at the end of the row before, so that the order can be followed.
        std::string points = first == 0 ? "" : place(sight.corners[first - 1]);
        for (std::size_t k = first; k < std::min(first + per_row, sight.corners.size()); ++k)
            points += place(sight.corners[k]);
        points.pop_back();
        svg += fill(R"(<polyline class="chain row{}" points="{}"/>)", {first / per_row % 7, points});
    }
    if (!sight.corners.empty())
        svg += fill(R"(<circle class="first" cx="{}" cy="{}" r="{}"/>)",
                    {fixed(scale * (sight.corners[0].x + 0.5), 1), fixed(scale * (sight.corners[0].y + 0.5), 1),
                     fixed(5 * stroke, 1)});
    return svg + "</svg>\n";
}

std::string rectified_drawing(const CalibrationRun& run, const Rectification& flat, const SeenPair& pair,
                              const PairPictures& pictures)
{
    constexpr int kGap = 8;
    constexpr int kLines = 16;
    const int width = pictures.left.width;
    const int height = pictures.left.height;
    const double scale = static_cast<double>(width) / run.task.width;
    std::string svg = fill(R"(<svg viewBox="0 0 {} {}" role="img" aria-label="Both rectified pictures">)",
                           {2 * width + kGap, height});
    std::string crosses;
    for (const Eye eye : kEyes) {
        const int x0 = eye == Eye::kLeft ? 0 : width + kGap;
        svg += fill(R"(<image href="{}" x="{}" width="{}" height="{}"/>)",
                    {eye == Eye::kLeft ? pictures.left.file : pictures.right.file, x0, width, height});
        for (const Point2& corner : eye == Eye::kLeft ? pair.left.corners : pair.right.corners)
            if (const auto p = rectified(run.calibration.rig, flat, eye, corner))
                crosses += fill("M{} {}m-6 0h12m-6 -6v12",
                                {fixed(x0 + scale * (p->x + 0.5), 1), fixed(scale * (p->y + 0.5), 1)});
    }
    for (int k = 0; k < kLines; ++k)
        svg +=
            fill(R"(<path class="row-line" d="M0 {}h{}"/>)", {fixed((k + 0.5) * height / kLines, 1), 2 * width + kGap});
    return svg + fill(R"(<path class="cross" d="{}"/></svg>)", {crosses}) + "\n";
}

} // namespace dicot::app
