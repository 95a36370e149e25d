#include "hub.h"

#include <fcntl.h>
#include <poll.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

namespace dicot::usbip {

namespace {

constexpr Microseconds kPortRecovers = 50'000; // until the next try to plug in again
constexpr int kLongestWaitMs = 1000;

Microseconds now_us()
{
    timespec time = {};
    ::clock_gettime(CLOCK_MONOTONIC, &time);
    return Microseconds{time.tv_sec} * 1'000'000 + time.tv_nsec / 1000;
}

} // namespace

void Hub::log(const std::string& name, const std::string& event) const
{
    std::printf("%s: %s\n", name.c_str(), event.c_str());
    std::fflush(stdout);
}

Status Hub::add(const CameraWish& wish)
{
    auto seat = std::make_unique<Seat>();
    TRY(seat->frames.open(wish.frames));
    seat->port = wish.port;
    CameraModel model = wish.model;
    model.formats = seat->frames.formats();
    Seat* borrowed = seat.get();
    const std::string name = model.name;
    seat->camera = std::make_unique<Camera>(
        std::move(model), Camera::Surroundings{seat->frames, bus_,
                                               [borrowed](const Bytes& message) {
                                                   // A host that has let go is noticed where messages are read.
                                                   (void)borrowed->plug.send(message);
                                               },
                                               [this, name](const std::string& event) { log(name, event); }});
    seats_.push_back(std::move(seat));
    return {};
}

Status Hub::take_line(const std::string& text, int number)
{
    Line line = TRY(read_line(text, number));
    if (!line.fault && !line.order)
        return {};
    if (line.order && line.order->verb == Order::Verb::kQuit) {
        quit_ = true;
        return {};
    }
    const std::string& name = line.fault ? line.fault->camera : line.order->camera;
    const auto seat =
        std::find_if(seats_.begin(), seats_.end(), [&](const auto& one) { return one->camera->model().name == name; });
    if (seat == seats_.end())
        return failure(Fault::kConfig, "line %d: there is no camera '%s'", number, name.c_str());
    if (line.fault)
        (*seat)->camera->add_fault(std::move(*line.fault));
    else
        obey(**seat, line.order->verb);
    return {};
}

void Hub::obey(Seat& seat, Order::Verb verb)
{
    if (verb == Order::Verb::kForget)
        seat.camera->faults().forget();
    else if (verb == Order::Verb::kUnplug)
        unplug(seat);
    else if (!seat.plug.is_in())
        seat.back_at = now_us();
}

Status Hub::read_plan(const std::string& path)
{
    std::ifstream file(path);
    if (!file)
        return failure(Fault::kNoInput, "%s: cannot be read", path.c_str());
    int number = 0;
    for (std::string line; std::getline(file, line);)
        TRY(take_line(line, ++number));
    return {};
}

Status Hub::open_commands(const std::string& path)
{
    // Open for writing too: the pipe then never ends when a writer goes.
    commands_ = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (commands_ < 0)
        return failure(Fault::kNoInput, "%s: %s; make a pipe with mkfifo", path.c_str(), std::strerror(errno));
    return {};
}

void Hub::read_commands()
{
    char bytes[4096];
    const ssize_t got = ::read(commands_, bytes, sizeof bytes);
    command_bytes_.append(bytes, static_cast<std::size_t>(got > 0 ? got : 0));
    for (std::size_t end = command_bytes_.find('\n'); end != std::string::npos; end = command_bytes_.find('\n')) {
        const std::string line = command_bytes_.substr(0, end);
        command_bytes_.erase(0, end + 1);
        const Status status = take_line(line, ++command_lines_);
        log("command", status.ok() ? "taken: " + line : status.message());
    }
}

Status Hub::plug_in(Seat& seat)
{
    seat.camera->power_on();
    TRY(seat.plug.plug_in(seat.port));
    seat.back_at = -1;
    log(seat.camera->model().name, "plugged in");
    return {};
}

void Hub::unplug(Seat& seat)
{
    if (!seat.plug.is_in())
        return;
    seat.plug.pull();
    seat.camera->power_off();
    log(seat.camera->model().name, "unplugged");
}

void Hub::receive(Seat& seat, Microseconds now)
{
    bool alive = seat.plug.receive();
    while (alive && seat.plug.is_in()) {
        Read read = seat.plug.next();
        alive = !read.broken;
        if (!read.request)
            break;
        seat.camera->take(std::move(*read.request), now);
    }
    if (!alive)
        unplug(seat);
}

void Hub::serve(Seat& seat, Microseconds now)
{
    if (seat.plug.is_in()) {
        if (const std::optional<Microseconds> back = seat.camera->serve(now)) {
            unplug(seat);
            seat.back_at = *back > 0 ? now + *back : -1;
        }
    } else if (seat.back_at >= 0 && now >= seat.back_at && !plug_in(seat).ok()) {
        seat.back_at = now + kPortRecovers;
    }
}

int Hub::wait_ms(Microseconds now) const
{
    Microseconds next = now + kLongestWaitMs * Microseconds{1000};
    for (const auto& seat : seats_) {
        if (!seat->plug.is_in() && seat->back_at >= 0)
            next = std::min(next, seat->back_at);
        if (const std::optional<Microseconds> due = seat->camera->deadline(); due && seat->plug.is_in())
            next = std::min(next, *due);
    }
    return next <= now ? 0 : static_cast<int>((next - now + 999) / 1000);
}

Status Hub::run()
{
    for (const auto& seat : seats_)
        TRY(plug_in(*seat));
    std::vector<pollfd> waits(seats_.size() + 1);
    while (!quit_) {
        for (std::size_t i = 0; i < seats_.size(); ++i)
            waits[i] = {seats_[i]->plug.socket(), POLLIN, 0}; // poll passes over -1
        waits.back() = {commands_, POLLIN, 0};
        if (::poll(waits.data(), waits.size(), wait_ms(now_us())) < 0 && errno != EINTR)
            return failure(Fault::kOsError, "poll: %s", std::strerror(errno));
        if ((waits.back().revents & POLLIN) != 0)
            read_commands();
        for (std::size_t i = 0; i < seats_.size(); ++i) {
            if (waits[i].revents != 0 && seats_[i]->plug.is_in())
                receive(*seats_[i], now_us());
            serve(*seats_[i], now_us());
        }
    }
    return {};
}

} // namespace dicot::usbip
