#include "live_run.h"

#include "../../cameras/rig_stream.h"
#include "../../stop_request.h"
#include "../../take_picture.h"
#include "../seen_picture.h"
#include "live_screen.h"
#include "pair_folder.h"

#include "dicot/calibration/grey.h"
#include "dicot/calibration/solve.h"
#include "dicot/os/clock.h"
#include "dicot/os/memory_block.h"
#include "dicot/os/shown_path.h"
#include "dicot/picture/read_picture.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace dicot::app {
namespace {

using calibration::BoardSight;

/// The pictures that everything happens in, taken once.
struct Table
{
    MemoryBlock block;
    std::array<ImageView<Rgb8>, 2> colour;
    std::array<ImageView<std::uint8_t>, 2> grey;

    static Result<Table> lay(int width, int height)
    {
        Table table;
        const auto lay_out = [&](Arena& arena) {
            for (std::size_t side = 0; side < 2; ++side) {
                table.colour[side] = take_picture<Rgb8>(arena, width, height);
                table.grey[side] = take_picture<std::uint8_t>(arena, width, height);
            }
        };
        Arena measure;
        lay_out(measure);
        table.block = TRY(MemoryBlock::map(measure.peak()));
        Arena arena(table.block.bytes());
        lay_out(arena);
        return table;
    }
};

class LiveRun
{
public:
    LiveRun(const LivePlan& plan, Crew& crew, RigStream stream, Table table, PairFolder folder)
        : plan_(plan), crew_(crew), stream_(std::move(stream)), table_(std::move(table)), folder_(std::move(folder)),
          guide_(plan.board, stream_.width(), stream_.height(), plan.range, plan.pairs), screen_(plan.json)
    {
    }

    Status run()
    {
        const StopRequest stop;
        const Status taken = take();
        (void)stream_.stop(); // what is on the disk counts, whatever the cameras say now
        if (guide_.kept() == 0)
            folder_.remove_if_empty();
        else if (!taken.ok())
            say_how_to_go_on();
        return taken;
    }

private:
    Status take()
    {
        TRY(count_earlier_pairs());
        if (guide_.done())
            return {};
        screen_.say("the cameras warm up: hold the board out of their sight");
        TRY(stream_.start());
        TRY(stream_.cameras().warm_up());
        const std::int64_t end_us = stream_.now_us() + static_cast<std::int64_t>(plan_.seconds * 1e6);
        began_us_ = monotonic_us();
        while (!guide_.done()) {
            if (StopRequest::asked())
                return failure(Fault::kTryAgain, "stopped after %d of %d pairs", guide_.kept(), guide_.wanted());
            if (stream_.now_us() >= end_us)
                return at_the_end_of_time();
            const Result<LivePair> pair = stream_.next(table_.colour[0], table_.colour[1]);
            if (!pair.ok() && StopRequest::asked())
                continue;
            TRY(pair.status());
            TRY(look_at(pair.value(), end_us - stream_.now_us()));
        }
        return {};
    }

    Status at_the_end_of_time()
    {
        if (guide_.kept() >= calibration::kMinPairs) {
            screen_.say("the time is over: " + std::to_string(guide_.kept()) + " of " +
                        std::to_string(guide_.wanted()) + " pairs were taken");
            return {};
        }
        return failure(Fault::kTryAgain, "%d pairs in %.0f s are too few: give more time with --seconds, and %s",
                       guide_.kept(), plan_.seconds, guide_.advice().c_str());
    }

    std::array<BoardSight, 2> glance_at_both()
    {
        std::array<BoardSight, 2> sights;
        crew_.run(2, [&](int side) {
            const auto s = static_cast<std::size_t>(side);
            calibration::to_grey(table_.colour[s], table_.grey[s]);
            sights[s] = calibration::glance(table_.grey[s], plan_.board);
        });
        return sights;
    }

    Status look_at(const LivePair& pair, std::int64_t left_us)
    {
        std::array<BoardSight, 2> sights = glance_at_both();
        ++looks_;
        LiveMoment now;
        now.sight = guide_.see(sights[0], std::move(sights[1]), pair.left_start_us);
        now.advice = guide_.advice();
        now.still_us = guide_.still_us();
        now.skew_us = pair.skew_us;
        now.left_us = left_us;
        now.looks_per_s = looks_ * 1e6 / static_cast<double>(std::max<std::int64_t>(monotonic_us() - began_us_, 1));
        if (now.sight == LiveSight::kTake) {
            TRY(folder_.add(table_.colour[0], table_.colour[1]));
            guide_.keep();
        }
        now.kept = guide_.kept();
        now.wanted = guide_.wanted();
        now.coverage = guide_.coverage();
        if (now.sight == LiveSight::kTake)
            screen_.taken(now, folder_.last_name());
        else
            screen_.look(now);
        return {};
    }

    /// The guide sees the pairs of an earlier run, so that none is taken twice; what cannot be used is passed over
    /// here and named by the calibration.
    Status count_earlier_pairs()
    {
        const std::array boards{plan_.board};
        for (const KeptPair& kept : folder_.earlier()) {
            const PictureSize size = TRY(picture_size(kept.left.c_str()));
            if (size.width != stream_.width() || size.height != stream_.height())
                return failure(Fault::kBadData,
                               "%s is %d x %d px, the cameras' pictures are %d x %d: name an empty folder with "
                               "--images",
                               shown_path(kept.left.c_str()), size.width, size.height, stream_.width(),
                               stream_.height());
            SeenPicture left("", kept.left, {0});
            SeenPicture right("", kept.right, {0});
            left.look(boards);
            right.look(boards);
            if (!left.found(0) || !right.found(0))
                continue;
            if (guide_.see(left.sights[0], right.sights[0], 0) >= LiveSight::kMoving && !guide_.done())
                guide_.keep();
        }
        if (guide_.kept() > 0)
            screen_.say(std::to_string(guide_.kept()) + " pairs are there already");
        return {};
    }

    void say_how_to_go_on()
    {
        std::array<char, 200> words{};
        std::snprintf(words.data(), words.size(), " --corners %dx%d --square-mm %g -o ", plan_.board.cols,
                      plan_.board.rows, plan_.board.square_mm);
        screen_.say(std::to_string(guide_.kept()) + " pairs are kept in " + folder_.path() +
                    ": take more with the same words and --resume, or calibrate with them: dicot calibrate --images " +
                    folder_.path() + words.data() + plan_.rig);
    }

    const LivePlan& plan_;
    Crew& crew_;
    RigStream stream_;
    Table table_;
    PairFolder folder_;
    LiveGuide guide_;
    LiveScreen screen_;
    std::int64_t began_us_ = 0;
    int looks_ = 0;
};

} // namespace

Status take_pairs(const LivePlan& plan, Crew& crew)
{
    const LoadedConfig loaded = TRY(load_config(plan.config));
    // Recorded pictures wait for nobody to move the board.
    const bool recorded = loaded.config.cameras.left.by == BoundBy::kReplay;
    RigStream stream = TRY(RigStream::open(loaded.config, recorded ? Pace::kAtOnce : Pace::kReal));
    Table table = TRY(Table::lay(stream.width(), stream.height()));
    PairFolder folder = TRY(PairFolder::open(plan.folder, plan.resume));
    LiveRun run(plan, crew, std::move(stream), std::move(table), std::move(folder));
    return run.run();
}

} // namespace dicot::app
