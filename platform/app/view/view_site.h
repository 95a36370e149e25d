// What dicot view shows, as answers to paths: the same for its server and for an exported folder.
#pragma once

#include "growth_job.h"
#include "recent.h"
#include "view_board.h"

#include "dicot/base/status.h"

#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace dicot::app {

struct Answer
{
    int status = 200; ///< as HTTP has it
    const char* type = "text/plain; charset=utf-8";
    std::shared_ptr<const std::string> body; ///< of what is not 200: a sentence for a person
};

/// The page, bundled and with all that it needs; and the policy (CSP 3) that allows its own parts alone: from the
/// server as a header, in an export within the page.
std::string_view view_page();
std::string_view server_policy();
std::string_view files_policy();

/// Paths are looked up among those that there are (README.md, "What the page reads"): none of them names a file.
/// Several threads may ask at once.
class ViewSite
{
public:
    /// `path`: an archive, a store, the folder of one board, or a cloud file. `wishes`: which plants, and of each board
    /// only so many slots, the newest (query.last). Errors: boards_of_archive()'s, ViewBoard::of_cloud()'s.
    static Result<std::unique_ptr<ViewSite>> open(const std::string& path, const TraitsWishes& wishes);

    /// data/archive.json also looks for what came and went since.
    Answer answer(std::string_view path);
    /// All paths that are there, but for the page.
    std::vector<std::string> paths();
    /// Answers about growth wait until every snapshot is measured.
    void wait_for_growth() { waits_for_growth_ = true; }

private:
    struct Board
    {
        Status opened;
        std::string name;
        std::shared_ptr<const ViewBoard> slots; ///< null: `opened` says why
        std::shared_ptr<GrowthJob> growth;      ///< null: a cloud alone has none
    };
    /// What is made of one cloud.
    struct Seen
    {
        Answer plants, leaves, left, disparity;
    };

    ViewSite(std::string path, const TraitsWishes& wishes) : path_(std::move(path)), wishes_(wishes) {}
    Status look();
    Board open_folder(const DeviceFolder& folder);
    Answer archive();
    Answer of_board(const Board& board, std::string_view file);
    Answer of_slot(const Board& board, const SlotRow& row, std::string_view file, const std::string& path);
    Answer thumbnail(const Board& board, const SlotRow& row, const std::string& path);
    std::shared_ptr<const Seen> seen(const Board& board, const SlotRow& row);

    std::string path_;
    TraitsWishes wishes_;
    bool waits_for_growth_ = false;
    std::mutex looking_; ///< boards_ and what is kept
    std::vector<Board> boards_;
    Recent<Answer> thumbnails_{2000};
    Recent<std::shared_ptr<const Seen>> seen_{16};
    std::mutex working_; ///< one cloud at a time
};

} // namespace dicot::app
