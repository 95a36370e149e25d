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

constexpr std::int64_t kMore = 4;

} // namespace

GrowthJob::GrowthJob(DeviceFolder board, const TraitsWishes& wishes)
    : board_(std::move(board)), wishes_(wishes), curves_(no_curves())
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
    if (working_ || !more_wanted_)
        return;
    if (thread_.joinable())
        thread_.join();
    working_ = true;
    more_wanted_ = false;
    curves_["complete"] = false;
    thread_ = std::thread([this] { work(); });
}

void GrowthJob::look_again()
{
    const std::scoped_lock lock(guard_);
    more_wanted_ = true;
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
    while (measure(slots_))
        slots_ *= kMore;
    const std::scoped_lock lock(guard_);
    working_ = false;
    curves_["complete"] = true;
    told_.notify_all();
}

bool GrowthJob::measure(std::int64_t slots)
{
    TraitsWishes wishes = wishes_;
    wishes.query.last = std::min(slots, wishes_.query.last.value_or(slots));
    json curves;
    std::int64_t seen = 0;
    const Status done = [&]() -> Status {
        // What cannot be measured is told where it is looked at.
        const BoardTraits board = TRY(measure_board(board_, wishes, [](const Status&) {}));
        seen = std::ssize(board.slots);
        curves = curves_json(board, TRY(board_growth(board, wishes.places)));
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
