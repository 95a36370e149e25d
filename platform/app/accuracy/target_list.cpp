#include "target_list.h"

#include "../calibrate/picture_name.h"
#include "csv_table.h"

#include "dicot/os/shown_path.h"
#include "dicot/picture/read_picture.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace dicot::app {
namespace {

constexpr const char* kDistance = "distance_mm";

std::string joined(const std::string& folder, const std::string& name)
{
    return (std::filesystem::path(folder) / name).string();
}

bool tells_distances(const std::string& path)
{
    const Result<CsvTable> table = read_csv(path);
    return table.ok() && table.value().column(kDistance).has_value();
}

/// Empty when the folder holds none.
Result<std::string> table_in(const std::string& folder)
{
    std::vector<std::string> tables;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        if (entry->path().extension() == ".csv" && tells_distances(entry->path().string()))
            tables.push_back(entry->path().string());
    std::ranges::sort(tables);
    if (tables.size() > 1)
        return failure(Fault::kUsage, "%s and %s both tell distances: choose one with --table",
                       shown_path(tables[0].c_str()), shown_path(tables[1].c_str()));
    return tables.empty() ? std::string{} : tables.front();
}

std::array<Point2, 4> corners_of(const TargetBox& box)
{
    const double left = box[0] - 0.5, top = box[1] - 0.5;
    const double right = left + box[2], bottom = top + box[3];
    return {Point2{left, top}, Point2{right, top}, Point2{right, bottom}, Point2{left, bottom}};
}

TargetBox middle_of(const PictureSize& size)
{
    const int width = std::max(1, static_cast<int>(size.width * kMiddleShare));
    const int height = std::max(1, static_cast<int>(size.height * kMiddleShare));
    return {(size.width - width) / 2, (size.height - height) / 2, width, height};
}

std::array<Point2, 4> inner_part(const std::array<Point2, 4>& corners)
{
    Point2 middle;
    for (const Point2& c : corners)
        middle = {middle.x + c.x / 4, middle.y + c.y / 4};
    std::array<Point2, 4> inner{};
    for (std::size_t k = 0; k < corners.size(); ++k)
        inner[k] = {middle.x + kInnerShare * (corners[k].x - middle.x),
                    middle.y + kInnerShare * (corners[k].y - middle.y)};
    return inner;
}

/// The cells of a table's rows, by the names of their columns.
class Rows
{
public:
    Rows(const std::string& path, CsvTable table) : path_(path), table_(std::move(table)) {}

    std::size_t count() const { return table_.rows.size(); }
    bool has(const std::string& name) const { return table_.column(name).has_value(); }
    int line(std::size_t row) const { return table_.lines[row]; }
    const std::string& text(std::size_t row, const std::string& name) const
    {
        return table_.rows[row][*table_.column(name)];
    }
    Result<double> number(std::size_t row, const std::string& name) const
    {
        const std::optional<double> value = number_in(text(row, name));
        if (!value)
            return failure(Fault::kBadData, "%s: line %d: %s is \"%.40s\", which is no number",
                           shown_path(path_.c_str()), line(row), name.c_str(), text(row, name).c_str());
        return *value;
    }
    Result<Point3> point(std::size_t row, const std::string& before, const std::string& after) const
    {
        return Point3{TRY(number(row, before + "x" + after)), TRY(number(row, before + "y" + after)),
                      TRY(number(row, before + "z" + after))};
    }

private:
    const std::string& path_;
    CsvTable table_;
};

constexpr std::array<const char*, 4> kCorners{"left_tl", "left_tr", "left_br", "left_bl"};

bool tells_corners(const Rows& rows)
{
    return std::ranges::all_of(kCorners, [&](const char* corner) {
        return rows.has(std::string(corner) + "_u") && rows.has(std::string(corner) + "_v");
    });
}

bool tells_planes(const Rows& rows)
{
    return std::ranges::all_of(
        std::array{"normal_x", "normal_y", "normal_z", "centre_x_mm", "centre_y_mm", "centre_z_mm"},
        [&](const char* name) { return rows.has(name); });
}

/// The pair of the folder whose left picture is called so, or begins so.
const PicturePair* pair_called(const PairedNames& names, const std::string& name)
{
    for (const PicturePair& pair : names.pairs)
        if (pair.left == name || (pair.left.starts_with(name) && pair.left.size() > name.size() &&
                                  std::isalnum(static_cast<unsigned char>(pair.left[name.size()])) == 0))
            return &pair;
    return nullptr;
}

Status add_row(const Rows& rows, std::size_t row, const TargetWords& words, const std::string& table,
               const PairedNames& names, std::vector<Target>& targets)
{
    const std::string folder = std::filesystem::path(table).parent_path().string();
    Target target;
    target.distance_mm = TRY(rows.number(row, kDistance));
    if (rows.has("left") && rows.has("right")) {
        target.left_path = joined(folder, rows.text(row, "left"));
        target.right_path = joined(folder, rows.text(row, "right"));
        target.name = rows.has("name") ? rows.text(row, "name") : rows.text(row, "left");
    } else {
        target.name = rows.text(row, "name");
        const PicturePair* pair = pair_called(names, target.name);
        if (pair == nullptr)
            return failure(Fault::kNoInput, "%s: line %d: no pair in %s is called \"%.60s\"", shown_path(table.c_str()),
                           rows.line(row), shown_path(words.folder.c_str()), target.name.c_str());
        target.left_path = joined(words.folder, pair->left);
        target.right_path = joined(words.folder, pair->right);
    }
    if (words.box) {
        target.corners = corners_of(*words.box);
    } else if (tells_corners(rows)) {
        for (std::size_t k = 0; k < kCorners.size(); ++k)
            target.corners[k] = {TRY(rows.number(row, std::string(kCorners[k]) + "_u")),
                                 TRY(rows.number(row, std::string(kCorners[k]) + "_v"))};
        target.corners = inner_part(target.corners);
    } else {
        target.corners = corners_of(middle_of(TRY(picture_size(target.left_path.c_str()))));
    }
    if (tells_planes(rows))
        target.plane = Plane{TRY(rows.point(row, "normal_", "")), TRY(rows.point(row, "centre_", "_mm"))};
    targets.push_back(target);
    return {};
}

Result<std::vector<Target>> targets_of_table(const TargetWords& words, const std::string& path)
{
    const char* shown = shown_path(path.c_str());
    const Rows rows(path, TRY(read_csv(path)));
    if (!rows.has(kDistance))
        return failure(Fault::kBadData, "%s: no column is called %s", shown, kDistance);
    const bool named = rows.has("left") && rows.has("right");
    if (!named && !rows.has("name"))
        return failure(Fault::kBadData, "%s: which pictures? Add the columns left and right, or name", shown);
    if (rows.count() == 0)
        return failure(Fault::kBadData, "%s: holds the names of its columns and nothing else", shown);
    const PairedNames names = named ? PairedNames{} : TRY(pairs_in_folder(words.folder));
    std::vector<Target> targets;
    for (std::size_t row = 0; row < rows.count(); ++row)
        TRY(add_row(rows, row, words, path, names, targets));
    return targets;
}

Result<std::vector<Target>> targets_of_names(const TargetWords& words, const PairedNames& names)
{
    std::vector<Target> targets;
    for (const PicturePair& pair : names.pairs) {
        Target target;
        target.name = std::filesystem::path(pair.left).stem().string();
        target.left_path = joined(words.folder, pair.left);
        target.right_path = joined(words.folder, pair.right);
        const std::optional<double> distance = distance_in_name(pair.left);
        if (!distance)
            return failure(Fault::kBadData,
                           "%s tells no distance: call it, for example, box_488mm_left.jpg, or tell the distances in "
                           "a table (see 'dicot accuracy --help')",
                           shown_path(target.left_path.c_str()));
        target.distance_mm = *distance;
        target.corners = corners_of(words.box ? *words.box : middle_of(TRY(picture_size(target.left_path.c_str()))));
        targets.push_back(target);
    }
    return targets;
}

Status check(const Target& target, const TargetWords& words)
{
    const PictureSize left = TRY(picture_size(target.left_path.c_str()));
    const PictureSize right = TRY(picture_size(target.right_path.c_str()));
    if (left.width != right.width || left.height != right.height)
        return failure(Fault::kBadData, "%s is %d x %d px, and %s %d x %d: a pair has one size",
                       shown_path(target.right_path.c_str()), right.width, right.height,
                       shown_path(target.left_path.c_str()), left.width, left.height);
    if (!(target.distance_mm > 0))
        return failure(Fault::kBadData, "%s: a distance of %g mm: it is measured from the left camera forwards",
                       shown_path(target.left_path.c_str()), target.distance_mm);
    if (words.box) {
        const auto& [x, y, width, height] = *words.box;
        if (x < 0 || y < 0 || width < 1 || height < 1 || x > left.width - width || y > left.height - height)
            return failure(Fault::kUsage, "--box %d,%d,%d,%d does not lie in %s, which is %d x %d px", x, y, width,
                           height, shown_path(target.left_path.c_str()), left.width, left.height);
    }
    return {};
}

} // namespace

std::optional<double> distance_in_name(const std::string& left_name)
{
    const std::string text =
        read_name(std::filesystem::path(left_name).filename().string(), CameraNumbers::kFromZero).spelling;
    const auto digit = [&](std::size_t i) {
        return i < text.size() && std::isdigit(static_cast<unsigned char>(text[i])) != 0;
    };
    std::vector<double> plain, with_unit;
    for (std::size_t i = 0; i < text.size();) {
        if (!digit(i)) {
            ++i;
            continue;
        }
        const std::size_t begin = i;
        while (digit(i) || (text[i] == '.' && digit(i + 1) && text.substr(begin, i - begin).find('.') == text.npos))
            ++i;
        const double value = number_in(text.substr(begin, i - begin)).value_or(0);
        const std::size_t unit = i < text.size() && (text[i] == ' ' || text[i] == '_') ? i + 1 : i;
        const bool ends = unit + 2 >= text.size() || std::isalpha(static_cast<unsigned char>(text[unit + 2])) == 0;
        if (ends && text.compare(unit, 2, "mm") == 0)
            with_unit.push_back(value);
        else if (ends && text.compare(unit, 2, "cm") == 0)
            with_unit.push_back(10 * value);
        else
            plain.push_back(value);
    }
    const std::vector<double>& told = with_unit.empty() ? plain : with_unit;
    return told.size() == 1 ? std::optional(told.front()) : std::nullopt;
}

Result<TargetList> list_targets(const TargetWords& words)
{
    TargetList list;
    list.source = words.table.empty() ? TRY(table_in(words.folder)) : words.table;
    if (list.source.empty()) {
        const PairedNames names = TRY(pairs_in_folder(words.folder));
        list.alone = names.alone;
        list.targets = TRY(targets_of_names(words, names));
    } else {
        list.targets = TRY(targets_of_table(words, list.source));
    }
    for (const Target& target : list.targets)
        TRY(check(target, words));
    std::ranges::stable_sort(list.targets, {}, &Target::distance_mm);
    return list;
}

} // namespace dicot::app
