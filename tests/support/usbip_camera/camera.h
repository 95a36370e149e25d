// One virtual camera behind its cable: answers every request of the host.
#pragma once

#include "bus.h"
#include "controls.h"
#include "fault_book.h"
#include "frames.h"
#include "model.h"
#include "negotiation.h"
#include "stream.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace dicot::usbip {

class Camera
{
public:
    struct Surroundings
    {
        const FrameFolder& frames;
        Bus& bus;
        std::function<void(Bytes)> answer; ///< takes messages for the host
        std::function<void(const std::string&)> log;
    };

    /// `model.formats` are those of the frames.
    Camera(CameraModel model, Surroundings around);
    Camera(const Camera&) = delete;
    Camera& operator=(const Camera&) = delete;

    const CameraModel& model() const { return model_; }
    FaultBook& faults() { return faults_; }
    void add_fault(PlannedFault fault);

    /// As a camera is when it has got power: values as usual, no stream.
    void power_on();
    void power_off();
    void take(Request request, Microseconds now);
    /// As VideoStream.
    [[nodiscard]] std::optional<Microseconds> serve(Microseconds now);
    std::optional<Microseconds> deadline() const;

    /// The answer to a control request; public for tests.
    Reply control(const std::array<std::uint8_t, 8>& setup, std::span<const std::uint8_t> out, Microseconds now);

private:
    struct Setup;
    struct EarlyUnlink
    {
        Request request;
        Microseconds until; ///< then its transfer does not come any more
    };
    void unlink(const Request& request, Microseconds now);
    bool was_unlinked(const Request& request);
    Reply standard(const Setup& setup, Microseconds now);
    Reply descriptor(const Setup& setup);
    Reply class_request(const Setup& setup, std::span<const std::uint8_t> out, Microseconds now);
    Reply set_interface(int interface, int alternate, Microseconds now);
    void stop_streaming();

    CameraModel model_;
    std::string product_; ///< the name that it has without a fault
    Surroundings around_;
    FaultBook faults_;
    Controls controls_;
    Negotiation negotiation_;
    VideoStream stream_;
    std::vector<Request> status_reads_; ///< on the status endpoint, which never has anything to say
    std::vector<Request> mute_;         ///< control requests that are left without an answer
    std::vector<EarlyUnlink> early_;    ///< whose transfers have not come yet
    std::uint32_t last_submitted_ = 0;  ///< sequence numbers ascend, over a replugging too
    int configuration_ = 0;
    int alternate_ = 0;
};

} // namespace dicot::usbip
