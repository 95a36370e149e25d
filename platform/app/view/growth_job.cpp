#include "growth_job.h"

#include "../stop_request.h"
#include "../store/shown.h"
#include "../traits/growth_series.h"
#include "../traits/traits_cache.h"
#include "curves_json.h"

#include <algorithm>
#include <utility>

namespace dicot::app {
namespace {

using nlohmann::json;

constexpr std::int64_t kFirst = 16;
constexpr std::int64_t kMore = 4;

} // namespace

GrowthJob::GrowthJob(DeviceFolder board, std::optional<std::int64_t> last)
    : board_(std::move(board)), last_(last), curves_(no_curves())
{
}

GrowthJob::~GrowthJob()
{
    {
        const std::scoped_lock lock(guard_);
        ending_ = true;
    }
    if (thread_.joinable())
        thread_.join();
}

void GrowthJob::begin()
{
    const std::scoped_lock lock(guard_);
    if (working_ || complete_)
        return;
    if (thread_.joinable())
        thread_.join();
    working_ = true;
    thread_ = std::thread([this] { work(); });
}

void GrowthJob::look_again()
{
    const std::scoped_lock lock(guard_);
    complete_ = false;
}

json GrowthJob::curves()
{
    begin();
    const std::scoped_lock lock(guard_);
    return curves_;
}

json GrowthJob::all_curves()
{
    begin();
    std::unique_lock lock(guard_);
    told_.wait(lock, [this] { return !working_; });
    return curves_;
}

void GrowthJob::work()
{
    std::int64_t slots = kFirst;
    while (measure(slots))
        slots *= kMore;
    const std::scoped_lock lock(guard_);
    working_ = false;
    complete_ = true;
    curves_["complete"] = true;
    told_.notify_all();
}

bool GrowthJob::measure(std::int64_t slots)
{
    TraitsWishes wishes;
    wishes.query.last = std::min(slots, last_.value_or(slots));
    wishes.cache_folder = usual_cache_folder();
    wishes.threads = 1; // the other processors are for who looks
    json curves;
    std::int64_t seen = 0;
    const Status done = [&]() -> Status {
        wishes.maker = TRY(cache_maker());
        // What cannot be measured is told where it is looked at.
        const BoardTraits board = TRY(measure_board(board_, wishes, [](const Status&) {}));
        seen = std::ssize(board.slots);
        curves = curves_json(board, TRY(board_growth(board, {})));
        return {};
    }();
    const std::scoped_lock lock(guard_);
    if (done.ok())
        curves_ = std::move(curves);
    else
        curves_["error"] = shown(done.message());
    return done.ok() && !ending_ && seen == slots;
}

} // namespace dicot::app
