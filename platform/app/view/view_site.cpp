#include "view_site.h"

#include "../cloud_on_disk.h"
#include "../pull/archive_folder.h"
#include "../store/shown.h"
#include "../store/slot_words.h"
#include "curves_json.h"
#include "plants_json.h"
#include "seen_pictures.h"

#include <nlohmann/json.hpp>

#include <charconv>
#include <filesystem>
#include <utility>

namespace dicot::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kJson = "application/json";
constexpr const char* kBytes = "application/octet-stream";
constexpr const char* kJpeg = "image/jpeg";
constexpr const char* kPng = "image/png";
constexpr int kThumbnailWidth = 208; // px: two for each of the page's

Answer answer_of(const char* type, std::string body)
{
    return {200, type, std::make_shared<const std::string>(std::move(body))};
}

Answer answer_of(const json& value)
{
    return answer_of(kJson, json_text(value, -1));
}

Answer refusal(const Status& why)
{
    Answer answer;
    answer.status = why.fault() == Fault::kNoInput ? 404 : 500;
    answer.body = std::make_shared<const std::string>(shown(why.message()));
    return answer;
}

Answer not_there()
{
    return refusal(failure(Fault::kNoInput, "there is nothing of this name"));
}

/// The part before the next '/', which is taken away with it.
std::string_view next_part(std::string_view& path)
{
    const std::size_t end = std::min(path.find('/'), path.size());
    const std::string_view part = path.substr(0, end);
    path.remove_prefix(std::min(end + 1, path.size()));
    return part;
}

/// -1: it is no number as we write them.
std::int64_t number_in(std::string_view text)
{
    std::int64_t number = -1;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool whole = error == std::errc{} && end == text.data() + text.size();
    return whole && text == std::to_string(number) ? number : -1;
}

Result<CloudOnDisk> cloud_in(const ViewBoard& board, const SlotRow& row)
{
    const std::string file = TRY(board.read(row, "cloud.drc"));
    return CloudOnDisk::decode(std::as_bytes(std::span{file.data(), file.size()}), "cloud.drc");
}

} // namespace

Result<std::unique_ptr<ViewSite>> ViewSite::open(const std::string& path, const TraitsWishes& wishes)
{
    std::unique_ptr<ViewSite> site{new ViewSite(path, wishes)};
    TRY(site->look());
    return site;
}

/// What was measured of a board before it is looked at again stays measured.
ViewSite::Board ViewSite::open_folder(const DeviceFolder& folder)
{
    Board board{{}, folder.device, nullptr, nullptr};
    Result<ViewBoard> opened = ViewBoard::of_folder(folder, wishes_.query.last);
    if (!opened.ok()) {
        board.opened = opened.status();
        return board;
    }
    board.slots = std::make_shared<const ViewBoard>(std::move(opened).value());
    const std::scoped_lock lock(looking_);
    for (const Board& known : boards_)
        if (known.growth && known.growth->board().path == folder.path)
            board.growth = known.growth;
    if (board.growth)
        board.growth->look_again();
    else
        board.growth = std::make_shared<GrowthJob>(folder, wishes_);
    return board;
}

Status ViewSite::look()
{
    std::vector<Board> boards;
    std::error_code error;
    if (fs::is_regular_file(path_, error)) {
        auto slots = std::make_shared<const ViewBoard>(TRY(ViewBoard::of_cloud(path_)));
        boards.push_back({{}, slots->name(), slots, nullptr});
    } else {
        for (const DeviceFolder& folder : TRY(boards_of_archive(path_)))
            boards.push_back(open_folder(folder));
    }
    const std::scoped_lock lock(looking_);
    std::swap(boards_, boards);
    thumbnails_.clear();
    seen_.clear();
    return {};
}

Answer ViewSite::answer(std::string_view path)
{
    if (path.empty() || path == "index.html")
        return answer_of("text/html; charset=utf-8", std::string{view_page()});
    const std::string whole{path};
    if (next_part(path) != "data")
        return not_there();
    if (path == "archive.json")
        return archive();
    const std::int64_t number = number_in(next_part(path));
    Board board;
    {
        const std::scoped_lock lock(looking_);
        if (number < 0 || number >= std::ssize(boards_))
            return not_there();
        board = boards_[static_cast<std::size_t>(number)];
    }
    if (!board.opened.ok())
        return refusal(board.opened);
    if (path.find('/') == std::string_view::npos)
        return of_board(board, path);
    const SlotRow* row = board.slots->find(number_in(next_part(path)));
    return row == nullptr ? not_there() : of_slot(board, *row, path, whole);
}

Answer ViewSite::archive()
{
    if (const Status looked = look(); !looked.ok())
        return refusal(looked);
    const std::scoped_lock lock(looking_);
    json boards = json::array();
    for (const Board& board : boards_)
        boards.push_back({{"name", shown(board.name)}, {"slots", board.slots ? board.slots->slots().size() : 0}});
    fs::path folder{path_};
    if (!folder.has_filename())
        folder = folder.parent_path();
    return answer_of({{"name", shown(folder.filename().string())}, {"boards", boards}});
}

Answer ViewSite::of_board(const Board& board, std::string_view file)
{
    if (file == "slots.json")
        return answer_of(board.slots->slots_json());
    if (file == "curves.json")
        return answer_of(!board.growth       ? no_curves()
                         : waits_for_growth_ ? board.growth->all_curves()
                                             : board.growth->curves());
    return not_there();
}

Answer ViewSite::of_slot(const Board& board, const SlotRow& row, std::string_view file, const std::string& path)
{
    if (file == "snapshot.json")
        return answer_of(board.slots->snapshot_json(row));
    if (!row.done || row.kept != Kept::kHere)
        return not_there();
    if (file == "cloud.drc") {
        Result<std::string> read = board.slots->read(row, "cloud.drc");
        return read.ok() ? answer_of(kBytes, std::move(read).value()) : refusal(read.status());
    }
    if (file == "thumb.jpg")
        return thumbnail(board, row, path);
    if (file == "left.jpg")
        if (Result<std::string> read = board.slots->read(row, "left.jpg"); read.ok())
            return answer_of(kJpeg, std::move(read).value());
    if (file == "left.jpg")
        return seen(board, row)->left;
    if (file == "disparity.png")
        return seen(board, row)->disparity;
    if (file == "plants.json")
        return seen(board, row)->plants;
    if (file == "leaves.bin")
        return seen(board, row)->leaves;
    return not_there();
}

Answer ViewSite::thumbnail(const Board& board, const SlotRow& row, const std::string& path)
{
    {
        const std::scoped_lock lock(looking_);
        if (const Answer* kept = thumbnails_.find(path))
            return *kept;
    }
    const Answer left = of_slot(board, row, "left.jpg", path);
    if (left.status != 200)
        return left;
    const Result<OwnPicture> picture = OwnPicture::decode(*left.body, "left.jpg");
    if (!picture.ok())
        return refusal(picture.status());
    const Answer made = answer_of(kJpeg, jpeg_of(smaller(picture.value().view, kThumbnailWidth).view));
    const std::scoped_lock lock(looking_);
    thumbnails_.put(path, made);
    return made;
}

std::shared_ptr<const ViewSite::Seen> ViewSite::seen(const Board& board, const SlotRow& row)
{
    const std::scoped_lock work(working_);
    const std::string key = board.name + "/" + std::to_string(row.sequence);
    {
        const std::scoped_lock lock(looking_);
        if (const auto* kept = seen_.find(key))
            return *kept;
    }
    const auto made = std::make_shared<Seen>();
    const Status done = [&]() -> Status {
        const CloudOnDisk cloud = TRY(cloud_in(*board.slots, row));
        const PlantWork plants =
            TRY(PlantWork::make(cloud.cloud(), "cloud.drc", wishes_.places, cloud.meta().far_mm.value_or(0)));
        GridPlace place = place_of_its_own(plants.view());
        if (const Result<std::string> left = board.slots->read(row, "left.jpg"); left.ok())
            if (const Result<OwnPicture> picture = OwnPicture::decode(left.value(), "left.jpg"); picture.ok())
                place = place_in_picture(plants.view(), picture.value().view);
        made->left = made->disparity = not_there(); // too few points make no picture
        if (!plants.view().too_few) {
            made->left = answer_of(kJpeg, jpeg_of(picture_of(plants.view()).view));
            made->disparity = answer_of(kPng, png_of(disparity_of(plants.view(), place).view));
        }
        made->plants = answer_of(kJson, plants_json(plants, place));
        made->leaves = answer_of(kBytes, leaf_bytes(plants.leaves()));
        return {};
    }();
    if (!done.ok())
        made->left = made->disparity = made->plants = made->leaves = refusal(done);
    const std::scoped_lock lock(looking_);
    seen_.put(key, made);
    return made;
}

std::vector<std::string> ViewSite::paths()
{
    const std::scoped_lock lock(looking_);
    std::vector<std::string> all{"data/archive.json"};
    for (std::size_t i = 0; i < boards_.size(); ++i) {
        const std::string folder = "data/" + std::to_string(i) + "/";
        all.insert(all.end(), {folder + "slots.json", folder + "curves.json"});
        if (!boards_[i].slots)
            continue;
        for (const SlotRow& row : boards_[i].slots->slots()) {
            const std::string slot = folder + std::to_string(row.sequence) + "/";
            all.push_back(slot + "snapshot.json");
            if (row.done && row.kept == Kept::kHere)
                for (const char* file :
                     {"cloud.drc", "thumb.jpg", "left.jpg", "disparity.png", "plants.json", "leaves.bin"})
                    all.push_back(slot + file);
        }
    }
    return all;
}

} // namespace dicot::app
