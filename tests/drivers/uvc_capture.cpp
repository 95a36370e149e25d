// Captures frames through libusb and writes each to a file with its verdict; for machines with cameras, virtual or not.
//
//   uvc_capture list
//   uvc_capture capture OUT_FOLDER FORMAT WIDTH HEIGHT FPS FRAMES CAMERA [CAMERA]
//   uvc_capture cycles FORMAT WIDTH HEIGHT FPS CYCLES CAMERA
//   uvc_capture hold OUT_FOLDER FORMAT WIDTH HEIGHT FPS FRAMES CAMERA      keeps them all until ten more and a stop
//   went by uvc_capture ladder FORMAT WIDTH HEIGHT FPS FRAMES CAMERA               shakes a camera that stops
//   delivering uvc_capture controls CAMERA
//
// A CAMERA is a USB port or a serial number; "1-1@2" streams it through alternate setting 2. Two cameras stream at
// once. OUT_FOLDER/<camera>-<number>.<yuyv|mjpg|nv12|grey> holds the bytes; one line on standard output for each frame:
// camera, number, verdict, bytes, sequence, lost, start, flaw. Exit code 0 when all frames came.
#include "holdings.h"

#include "dicot/os/clock.h"
#include "dicot/os/heap_gate.h"
#include "dicot/uvc/uvc_camera.h"
#include "dicot/uvc/uvc_list.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace dicot;

constexpr std::int64_t kFrameUs = 6'000'000; ///< how long a frame may take under emulation

/// While it lives, operator new stops the program: a camera has all its memory once it is open.
struct Sealed
{
    Sealed() { heap_gate::seal(); }
    Sealed(const Sealed&) = delete;
    Sealed& operator=(const Sealed&) = delete;
    ~Sealed() { heap_gate::unseal(); }
};

int complain(const Status& status)
{
    std::fprintf(stderr, "uvc_capture: %s\n", status.message());
    return status.exit_code();
}

std::optional<PixelFormat> format_named(const std::string& name)
{
    for (const PixelFormat format : {PixelFormat::kYuyv, PixelFormat::kMjpeg, PixelFormat::kNv12, PixelFormat::kGrey})
        if (name == name_of(format))
            return format;
    return std::nullopt;
}

/// The mode of this size whose rate is nearest.
std::optional<CameraMode> mode_of(const Camera& camera, PixelFormat format, int width, int height, int fps)
{
    std::optional<CameraMode> best;
    const std::int64_t wanted = 10'000'000 / std::max(fps, 1);
    for (const CameraMode& mode : camera.modes()) {
        if (mode.format != format || mode.width != width || mode.height != height)
            continue;
        if (!best || std::llabs(mode.interval_100ns - wanted) < std::llabs(best->interval_100ns - wanted))
            best = mode;
    }
    return best;
}

int list()
{
    const Result<std::vector<UvcListed>> cameras = list_uvc_cameras();
    if (!cameras.ok())
        return complain(cameras.status());
    for (const UvcListed& camera : cameras.value()) {
        std::printf("%s %04x:%04x '%s' '%s' %s\n", camera.identity.port.text, unsigned{camera.identity.vendor},
                    unsigned{camera.identity.product}, camera.identity.name.text, camera.identity.serial.text,
                    camera.unusable.message());
        for (const UvcAlternate& one : camera.device.settings())
            std::printf("  setting %u: %u bytes%s\n", unsigned{one.setting.number}, one.setting.bytes_per_interval,
                        one.bulk ? ", bulk" : "");
    }
    return 0;
}

int controls(const char* which)
{
    Result<std::unique_ptr<UvcCamera>> opened = UvcCamera::open(which);
    if (!opened.ok())
        return complain(opened.status());
    UvcCamera& camera = *opened.value();
    for (const ControlRange& range : camera.controls()) {
        const Result<std::int32_t> now = camera.get(range.id);
        const Result<std::int32_t> set = camera.set(range.id, range.usual);
        std::printf("%s %d..%d step %d usual %d now %d set %d %s\n", name_of(range.id), range.least, range.most,
                    range.step, range.usual, now.ok() ? now.value() : -1, set.ok() ? set.value() : -1,
                    set.status().message());
    }
    return 0;
}

void write_frame(const std::string& path, const Frame& frame)
{
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (file == nullptr || std::fwrite(frame.bytes.data(), 1, frame.bytes.size(), file) != frame.bytes.size())
        std::fprintf(stderr, "uvc_capture: %s cannot be written\n", path.c_str());
    if (file != nullptr)
        std::fclose(file);
}

void print_frame(const std::string& name, int number, const Frame& frame)
{
    std::printf("%s %d %s %zu bytes, sequence %u, lost %u, start %lld%s%s\n", name.c_str(), number,
                name_of(frame.verdict), frame.bytes.size(), frame.sequence, frame.lost_before,
                static_cast<long long>(frame.start_us), *frame.flaw != '\0' ? ", " : "", frame.flaw);
}

struct Eye
{
    std::string name;
    std::unique_ptr<UvcCamera> camera;
    int got = 0;
    bool done = false;
};

/// Both cameras in turns, so that each has to keep streaming while the other is read.
int capture(const std::string& out, const CameraMode& wanted, int fps, int frames,
            const std::vector<std::string>& names)
{
    std::filesystem::create_directories(out);
    std::vector<Eye> eyes;
    for (const std::string& word : names) {
        const std::string name = word.substr(0, word.find('@'));
        Result<std::unique_ptr<UvcCamera>> opened = UvcCamera::open(name);
        if (!opened.ok())
            return complain(opened.status());
        if (name.size() < word.size())
            opened.value()->use_alternate(static_cast<std::uint8_t>(std::atoi(word.c_str() + name.size() + 1)));
        eyes.push_back({name, std::move(opened).value(), 0, false});
    }
    for (Eye& eye : eyes) {
        const auto mode = mode_of(*eye.camera, wanted.format, wanted.width, wanted.height, fps);
        if (!mode) {
            std::fprintf(stderr, "uvc_capture: %s has no such mode\n", eye.name.c_str());
            return 69;
        }
        const Status started = eye.camera->start(*mode);
        if (!started.ok())
            return complain(started);
        std::printf("%s streams %s %dx%d every %u x 100 ns, alternate %u\n", eye.name.c_str(), name_of(mode->format),
                    mode->width, mode->height, mode->interval_100ns, unsigned{eye.camera->alternate()});
    }
    const std::int64_t cpu_before = process_cpu_us();
    int worst = 0;
    for (int i = 0; i < frames; ++i) {
        for (Eye& eye : eyes) {
            if (eye.done)
                continue;
            const Result<FrameLease> lease = eye.camera->next(monotonic_us() + kFrameUs);
            if (!lease.ok()) {
                worst = complain(lease.status());
                eye.done = true;
                continue;
            }
            const Frame& frame = *lease.value();
            write_frame(out + "/" + eye.name + "-" + std::to_string(i) + "." + name_of(frame.mode.format), frame);
            print_frame(eye.name, i, frame);
        }
    }
    std::printf("cpu %lld us for %d frames of each camera\n", static_cast<long long>(process_cpu_us() - cpu_before),
                frames);
    for (Eye& eye : eyes) {
        const Status stopped = eye.camera->stop();
        if (!stopped.ok())
            worst = complain(stopped);
    }
    return worst;
}

/// Opens the camera and starts the mode of this size whose rate is nearest.
Result<std::unique_ptr<UvcCamera>> streaming(const std::string& name, const CameraMode& wanted, int fps)
{
    auto camera = TRY(UvcCamera::open(name));
    const auto mode = mode_of(*camera, wanted.format, wanted.width, wanted.height, fps);
    if (!mode)
        return failure(Fault::kUnavailable, "%s has no such mode", name.c_str());
    TRY(camera->start(*mode));
    return camera;
}

int hold(const std::string& out, const CameraMode& wanted, int fps, int frames, const std::string& name)
{
    std::filesystem::create_directories(out);
    const Result<std::unique_ptr<UvcCamera>> opened = streaming(name, wanted, fps);
    if (!opened.ok())
        return complain(opened.status());
    UvcCamera& camera = *opened.value();
    std::vector<FrameLease> held;
    for (int i = 0; i < frames + 10; ++i) {
        Result<FrameLease> lease = camera.next(monotonic_us() + kFrameUs);
        if (!lease.ok())
            return complain(lease.status());
        if (i < frames)
            held.push_back(std::move(lease).value());
    }
    const Status stopped = camera.stop();
    if (!stopped.ok())
        return complain(stopped);
    for (int i = 0; i < frames; ++i) {
        const Frame& frame = *held[static_cast<std::size_t>(i)];
        write_frame(out + "/" + name + "-" + std::to_string(i) + "." + name_of(frame.mode.format), frame);
        print_frame(name, i, frame);
    }
    return 0;
}

int ladder(const CameraMode& wanted, int fps, int frames, const std::string& name)
{
    const Result<std::unique_ptr<UvcCamera>> opened = streaming(name, wanted, fps);
    if (!opened.ok())
        return complain(opened.status());
    UvcCamera& camera = *opened.value();
    const Sealed sealed;
    int step = 0;
    for (int i = 0; i < frames;) {
        const Result<FrameLease> lease = camera.next(monotonic_us() + kFrameUs / 2);
        if (lease.ok()) {
            print_frame(name, i++, *lease.value());
            step = 0;
            continue;
        }
        std::printf("%s\n", lease.status().message());
        bool back = false;
        while (!back && step < 6) { // a slow machine may need more than one wait for a camera that comes back
            constexpr const char* names[] = {"restart", "reopen", "reopen", "reopen", "port", "port"};
            constexpr Shake steps[] = {Shake::kRestart, Shake::kReopen, Shake::kReopen,
                                       Shake::kReopen,  Shake::kPort,   Shake::kPort};
            const std::int64_t before = monotonic_us();
            const Status shaken = camera.shake(steps[step]);
            back = shaken.ok();
            std::printf("shake %s: %s after %lld ms\n", names[step], back ? "ok" : shaken.message(),
                        static_cast<long long>((monotonic_us() - before) / 1000));
            ++step;
        }
        if (!back)
            return 69;
    }
    return 0;
}

/// Starts and stops, with one frame each; memory and files must stay as they are after the first round.
int cycles(const CameraMode& wanted, int fps, int count, const std::string& name)
{
    Result<std::unique_ptr<UvcCamera>> opened = UvcCamera::open(name);
    if (!opened.ok())
        return complain(opened.status());
    UvcCamera& camera = *opened.value();
    const auto mode = mode_of(camera, wanted.format, wanted.width, wanted.height, fps);
    if (!mode)
        return 69;
    const Sealed sealed;
    for (int i = 0; i < count; ++i) {
        const Status started = camera.start(*mode);
        if (!started.ok())
            return complain(started);
        if (i % 100 == 0) {
            const Result<FrameLease> lease = camera.next(monotonic_us() + kFrameUs);
            if (!lease.ok())
                return complain(lease.status());
            const Holdings held = Holdings::now();
            std::printf("cycle %d: %s, resident %ld KiB, %ld maps, %ld files\n", i, name_of(lease.value()->verdict),
                        held.resident_kib, held.maps, held.descriptors);
        }
        const Status stopped = camera.stop();
        if (!stopped.ok())
            return complain(stopped);
    }
    const Holdings held = Holdings::now();
    std::printf("after %d cycles: resident %ld KiB, %ld maps, %ld files\n", count, held.resident_kib, held.maps,
                held.descriptors);
    return 0;
}

} // namespace

int main(int argc, char** argv)
{
    const std::vector<std::string> words(argv + 1, argv + argc);
    const auto number = [&](std::size_t i) { return std::atoi(words[i].c_str()); };
    if (words.size() == 1 && words[0] == "list")
        return list();
    if (words.size() == 2 && words[0] == "controls")
        return controls(words[1].c_str());
    if (words.size() >= 8 && words[0] == "capture")
        if (const auto format = format_named(words[2]))
            return capture(words[1], {*format, number(3), number(4), 0}, number(5), number(6),
                           {words.begin() + 7, words.end()});
    if (words.size() == 8 && words[0] == "hold")
        if (const auto format = format_named(words[2]))
            return hold(words[1], {*format, number(3), number(4), 0}, number(5), number(6), words[7]);
    if (words.size() == 7 && words[0] == "ladder")
        if (const auto format = format_named(words[1]))
            return ladder({*format, number(2), number(3), 0}, number(4), number(5), words[6]);
    if (words.size() == 7 && words[0] == "cycles")
        if (const auto format = format_named(words[1]))
            return cycles({*format, number(2), number(3), 0}, number(4), number(5), words[6]);
    std::fprintf(stderr, "uvc_capture: see the first lines of its source\n");
    return 64;
}
