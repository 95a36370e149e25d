#include "camera_source.h"

#include "../calibrate/pair_files.h"

#include "dicot/os/clock.h"
#include "dicot/os/memory_reserve.h"
#include "dicot/replay/replay_camera.h"

#include <array>
#include <filesystem>
#include <span>
#include <string_view>

namespace dicot::app {
namespace {

class ReplaySource final : public CameraSource
{
public:
    Status open(const CamerasConfig& config, Pace pace)
    {
        pace_ = pace;
        const std::string& of_left = config.left.what;
        const std::string& of_right = config.right.what.empty() ? of_left : config.right.what;
        const PairedNames lefts = TRY(pairs_in_folder(of_left));
        const PairedNames rights = TRY(pairs_in_folder(of_right));
        if (lefts.pairs.size() != rights.pairs.size())
            return failure(Fault::kBadData, "%s holds %zu pairs and %s %zu: recorded cameras need as many pictures",
                           of_left.c_str(), lefts.pairs.size(), of_right.c_str(), rights.pairs.size());
        for (std::size_t i = 0; i < lefts.pairs.size(); ++i) {
            left_.paths.push_back(std::filesystem::path(of_left) / lefts.pairs[i].left);
            right_.paths.push_back(std::filesystem::path(of_right) / rights.pairs[i].right);
        }
        const std::int64_t epoch_us = pace == Pace::kReal ? monotonic_us() : 0;
        now_us_ = epoch_us;
        TRY(open_side(left_, "replay/left", config.left_script(), epoch_us));
        TRY(open_side(right_, "replay/right", config.right_script(), epoch_us));
        const CameraMode& a = left_.camera.modes().front();
        const CameraMode& b = right_.camera.modes().front();
        if (a.width != b.width || a.height != b.height)
            return failure(Fault::kBadData,
                           "%s: the left pictures are %d x %d px and the right ones %d x %d: one size is needed",
                           of_left.c_str(), a.width, a.height, b.width, b.height);
        return {};
    }

    Camera& left() noexcept override { return left_.camera; }
    Camera& right() noexcept override { return right_.camera; }
    int width() const noexcept override { return left_.camera.modes().front().width; }
    int height() const noexcept override { return left_.camera.modes().front().height; }
    bool recorded() const noexcept override { return true; }
    std::size_t reserved_bytes() const noexcept override
    {
        return MemoryReserve::bytes_for(left_.camera.memory_bytes()) +
               MemoryReserve::bytes_for(right_.camera.memory_bytes());
    }
    std::int64_t* virtual_now_us() noexcept override { return pace_ == Pace::kAtOnce ? &now_us_ : nullptr; }

    BandwidthPlan plan(int refused) override
    {
        const std::array left{StreamOffer{left_.camera.modes().front(), 0}};
        const std::array right{StreamOffer{right_.camera.modes().front(), 0}};
        BusUser of_left;
        BusUser of_right;
        of_left.offers = left;
        of_right.offers = right;
        return plan_bandwidth(of_left, of_right, refused);
    }

private:
    struct Side
    {
        std::vector<std::string> paths;
        std::vector<const char*> files;
        ReplayCamera camera;
    };

    Status open_side(Side& side, const char* port, const std::string& script, std::int64_t epoch_us)
    {
        for (const std::string& path : side.paths)
            side.files.push_back(path.c_str());
        ReplayOptions options;
        options.port = port;
        options.script = TRY(parse_replay_script(script, "cameras.replay_script"));
        options.epoch_us = epoch_us;
        options.virtual_now_us = virtual_now_us();
        return side.camera.open(side.files, options);
    }

    Pace pace_ = Pace::kAtOnce;
    std::int64_t now_us_ = 0;
    Side left_, right_;
};

} // namespace

Result<std::unique_ptr<CameraSource>> open_replay(const CamerasConfig& config, Pace pace)
{
    auto source = std::make_unique<ReplaySource>();
    TRY(source->open(config, pace));
    return std::unique_ptr<CameraSource>(std::move(source));
}

Result<std::unique_ptr<CameraSource>> CameraSource::open(const CamerasConfig& config, Pace pace)
{
    return config.left.by == BoundBy::kReplay ? open_replay(config, pace) : open_usb_cameras(config);
}

} // namespace dicot::app
