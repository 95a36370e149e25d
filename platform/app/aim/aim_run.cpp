#include "aim_run.h"

#include "../cameras/rig_stream.h"
#include "../stop_request.h"
#include "aim_figures.h"
#include "aim_screen.h"

#include "dicot/base/arena.h"
#include "dicot/calibration/grey.h"
#include "dicot/os/memory_block.h"

#include <limits>
#include <utility>

namespace dicot::app {
namespace {

/// Pictures, and what is worked out of them.
struct Table
{
    MemoryBlock memory;
    ImageView<Rgb8> left_colour, right_colour;
    ImageView<std::uint8_t> left_grey, right_grey;
    std::span<std::byte> scratch; ///< of compare_views()

    void lay_out(Arena& arena, int width, int height)
    {
        const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        left_colour = {arena.take<Rgb8>(pixels).data(), width, height};
        right_colour = {arena.take<Rgb8>(pixels).data(), width, height};
        left_grey = {arena.take<std::uint8_t>(pixels).data(), width, height};
        right_grey = {arena.take<std::uint8_t>(pixels).data(), width, height};
        scratch = arena.take<std::byte>(aiming::view_scratch_bytes(width, height));
    }

    static Result<Table> make(int width, int height)
    {
        Table table;
        Arena measuring;
        table.lay_out(measuring, width, height);
        table.memory = TRY(MemoryBlock::map(measuring.peak()));
        Arena arena(table.memory.bytes());
        table.lay_out(arena, width, height);
        return table;
    }
};

/// Frames a second, out of counts that grow.
class Rate
{
public:
    double of(std::uint64_t count, std::int64_t now_us) noexcept
    {
        constexpr std::int64_t kWindowUs = 1'000'000;
        if (begun_us_ == kNever || count < count_) {
            begun_us_ = now_us;
            count_ = count;
        } else if (now_us - begun_us_ >= kWindowUs) {
            per_s_ = static_cast<double>(count - count_) * 1e6 / static_cast<double>(now_us - begun_us_);
            begun_us_ = now_us;
            count_ = count;
        }
        return per_s_;
    }

private:
    static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();
    std::int64_t begun_us_ = kNever;
    std::uint64_t count_ = 0;
    double per_s_ = 0;
};

class AimRun
{
public:
    AimRun(const Config& config, RigStream stream, Table table, bool json)
        : stream_(std::move(stream)), table_(std::move(table)), screen_(json)
    {
        now_.width = stream_.width();
        now_.height = stream_.height();
        now_.most_skew_ms = config.burst.most_skew_ms;
    }

    Status run(double seconds)
    {
        const StopRequest stop;
        const Status looked = look(seconds);
        const Status stopped = stream_.stop();
        if (!looked.ok() && looked.fault() == Fault::kIoError)
            return looked; // nobody reads a summary
        if (now_.pairs > 0)
            tell_time(); // a camera that died has taken its time
        TRY(screen_.end(now_));
        return looked.ok() ? stopped : looked;
    }

private:
    Status look(double seconds)
    {
        TRY(stream_.start());
        TRY(stream_.cameras().let_converge());
        begun_us_ = stream_.now_us();
        std::int64_t due_us = begun_us_;
        for (;;) {
            tell_time();
            if (StopRequest::asked() || (seconds > 0 && now_.elapsed_s >= seconds))
                return {};
            const Result<LivePair> pair = stream_.next(table_.left_colour, table_.right_colour);
            if (!pair.ok())
                return StopRequest::asked() ? Status{} : pair.status();
            ++now_.pairs;
            now_.skew_us = pair.value().skew_us;
            count_frames();
            if (stream_.now_us() < due_us)
                continue;
            due_us = stream_.now_us() + screen_.interval_us();
            TRY(work_out());
            TRY(screen_.show(now_));
        }
    }

    void tell_time() { now_.elapsed_s = static_cast<double>(stream_.now_us() - begun_us_) * 1e-6; }

    void count_frames()
    {
        const StereoFigures& figures = stream_.cameras().figures();
        const auto take = [&](AimSide& side, Rate& rate, const SideFigures& counted) {
            side.frames_per_s = rate.of(counted.whole, stream_.now_us());
            side.torn = counted.torn;
            side.lost = counted.lost;
        };
        take(now_.left, left_rate_, figures.left);
        take(now_.right, right_rate_, figures.right);
        now_.one_at_a_time = stream_.cameras().one_at_a_time();
    }

    Status work_out()
    {
        const auto see = [](AimSide& side, ImageView<Rgb8> colour, ImageView<std::uint8_t> grey) {
            calibration::to_grey(colour, grey);
            side.see(aiming::focus_of(grey), light_of(colour, grey));
        };
        see(now_.left, table_.left_colour, table_.left_grey);
        see(now_.right, table_.right_colour, table_.right_grey);
        Arena scratch(table_.scratch);
        const Result<aiming::Views> views = aiming::compare_views(table_.left_grey, table_.right_grey, scratch);
        now_.views = views.ok() ? views.value() : aiming::Views{}; // of some sizes they are not known
        return {};
    }

    RigStream stream_;
    Table table_;
    AimScreen screen_;
    AimMoment now_;
    Rate left_rate_, right_rate_;
    std::int64_t begun_us_ = 0;
};

} // namespace

Status aim(const Config& config, double seconds, bool json)
{
    RigStream stream = TRY(RigStream::open(config, Pace::kReal));
    Table table = TRY(Table::make(stream.width(), stream.height()));
    AimRun run(config, std::move(stream), std::move(table), json);
    return run.run(seconds);
}

} // namespace dicot::app
