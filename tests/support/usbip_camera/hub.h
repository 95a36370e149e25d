// Several cameras on one bus, served by one loop.
#pragma once

#include "bus.h"
#include "camera.h"
#include "fault.h"
#include "frames.h"
#include "options.h"
#include "plug.h"

#include <memory>
#include <string>
#include <vector>

namespace dicot::usbip {

class Hub
{
public:
    explicit Hub(int bus_bytes) : bus_(bus_bytes) {}

    /// Faults as FrameFolder::open().
    Status add(const CameraWish& wish);
    /// A file of lines as fault.h tells. Fault::kNoInput, kConfig.
    Status read_plan(const std::string& path);
    /// A pipe that lines are written into while the cameras run. Fault::kNoInput.
    Status open_commands(const std::string& path);
    /// Plugs all cameras in and serves them until a line says `quit`. A fault only if a camera cannot be plugged in at
    /// first.
    Status run();

    const Camera& camera(std::size_t index) const { return *seats_[index]->camera; }

private:
    struct Seat
    {
        FrameFolder frames;
        std::unique_ptr<Camera> camera;
        Plug plug;
        int port = 0;
        Microseconds back_at = -1; ///< when it plugs itself in again; -1: never
    };

    Status take_line(const std::string& line, int number);
    void obey(Seat& seat, Order::Verb verb);
    void read_commands();
    Status plug_in(Seat& seat);
    void unplug(Seat& seat);
    void serve(Seat& seat, Microseconds now);
    void receive(Seat& seat, Microseconds now);
    int wait_ms(Microseconds now) const;
    void log(const std::string& name, const std::string& event) const;

    Bus bus_;
    std::vector<std::unique_ptr<Seat>> seats_;
    int commands_ = -1;
    std::string command_bytes_;
    int command_lines_ = 0;
    bool quit_ = false;
};

} // namespace dicot::usbip
