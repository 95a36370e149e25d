#include "camera_source.h"

#include "../probe_report.h"
#include "camera_choice.h"

#include "dicot/os/memory_reserve.h"
#include "dicot/uvc/uvc_camera.h"

#include <array>

namespace dicot::app {
namespace {

/// One side: a camera behind the driver that was chosen for it.
struct Side
{
    SeenCamera seen;
    std::vector<StreamOffer> offers;
    std::unique_ptr<V4l2Camera> kernel;
    std::unique_ptr<UvcCamera> direct;
    std::size_t memory_bytes = 0;

    Camera& camera() noexcept { return kernel ? static_cast<Camera&>(*kernel) : *direct; }

    BusUser bus_user() const
    {
        return {.bus = seen.bus,
                .speed = seen.speed,
                .bulk = seen.bulk,
                .chooses_alternate = direct != nullptr,
                .settings = seen.settings,
                .offers = offers};
    }
};

class UsbSource final : public CameraSource
{
public:
    Status open(const CamerasConfig& config)
    {
        width_ = config.width;
        height_ = config.height;
        const V4l2Nodes nodes = list_v4l2_cameras();
        const Result<std::vector<UvcListed>> listed = list_uvc_cameras();
        const std::vector<SeenCamera> seen = seen_cameras(
            nodes, listed.ok() ? std::span<const UvcListed>{listed.value()} : std::span<const UvcListed>{});
        if (seen.empty())
            return no_camera(listed.ok(), nodes.denied);
        const ChosenCameras chosen = TRY(choose_cameras(config, seen));
        TRY(open_side(left_, *chosen.left, config));
        return open_side(right_, *chosen.right, config);
    }

    Camera& left() noexcept override { return left_.camera(); }
    Camera& right() noexcept override { return right_.camera(); }
    int width() const noexcept override { return width_; }
    int height() const noexcept override { return height_; }
    bool recorded() const noexcept override { return false; }
    std::size_t reserved_bytes() const noexcept override
    {
        return MemoryReserve::bytes_for(left_.memory_bytes) + MemoryReserve::bytes_for(right_.memory_bytes);
    }
    std::int64_t* virtual_now_us() noexcept override { return nullptr; }

    BandwidthPlan plan(int refused) override
    {
        const BandwidthPlan plan = plan_bandwidth(left_.bus_user(), right_.bus_user(), refused);
        if (left_.direct)
            left_.direct->use_alternate(plan.left.alternate);
        if (right_.direct)
            right_.direct->use_alternate(plan.right.alternate);
        return plan;
    }

private:
    Status open_side(Side& side, const SeenCamera& seen, const CamerasConfig& config)
    {
        side.seen = seen;
        const char* port = seen.identity.port.text;
        if (opens_through_kernel(seen, config.driver)) {
            side.kernel = std::make_unique<V4l2Camera>();
            TRY(side.kernel->open(port));
            side.offers = TRY(offers_for(config, side.camera()));
            return {};
        }
        UvcOptions options;
        options.slot_bytes = largest_frame(config);
        side.direct = TRY(UvcCamera::open(port, options));
        side.memory_bytes = UvcCamera::memory_bytes(side.direct->device(), options);
        side.offers = TRY(offers_for(config, side.camera()));
        for (StreamOffer& offer : side.offers)
            if (const Result<std::uint32_t> payload = side.direct->payload_bytes(offer.mode); payload.ok())
                offer.payload_bytes = payload.value();
        return {};
    }

    int width_ = 0;
    int height_ = 0;
    Side left_, right_;
};

} // namespace

Result<std::unique_ptr<CameraSource>> open_usb_cameras(const CamerasConfig& config)
{
    auto source = std::make_unique<UsbSource>();
    TRY(source->open(config));
    return std::unique_ptr<CameraSource>(std::move(source));
}

} // namespace dicot::app
