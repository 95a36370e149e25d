// Cameras through V4L2, from a script: each word after the camera is done in order and answered by lines.
//
//   v4l2_capture list
//   v4l2_capture WHERE[,WHERE] ACTION...
//
//   modes                          what the cameras offer
//   controls                       ranges and values of their controls
//   get NAME | set NAME VALUE
//   start FORMAT WIDTHxHEIGHT FPS
//   take N [DIR]                   N frames of each camera, in turn; files DIR/<camera>-<number>.<format>
//   drain                          frames of each camera until none comes in time
//   hold N                         N frames that stay lent until "release", which reads them once more
//   release
//   cycles N                       more than 10 times start, one frame, stop; then what the process holds
//   stop | shake restart|reopen|port
//   wait MS                        time for a frame in "take" (default 10000)
//   tries N                        how often a shake is begun until it helps (default 1)
//
// "failed ..." answers what did not work, with the fault's number, and the program goes on; exit 1 if there was one.
#include "holdings.h"

#include "dicot/os/clock.h"
#include "dicot/os/heap_gate.h"
#include "dicot/v4l2/v4l2_camera.h"

#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace dicot;

constexpr long kPagesOfLuckKib = 64;
constexpr int kMostDrained = 100;

int failures = 0;

bool good(const Status& status)
{
    if (status.ok())
        return true;
    ++failures;
    std::printf("failed %d %s\n", status.exit_code(), status.message());
    return false;
}

std::optional<PixelFormat> format_named(const std::string& name)
{
    for (const PixelFormat format : {PixelFormat::kYuyv, PixelFormat::kMjpeg, PixelFormat::kNv12, PixelFormat::kGrey})
        if (name == name_of(format))
            return format;
    return std::nullopt;
}

std::string words_of(const CameraMode& mode)
{
    return std::string{name_of(mode.format)} + " " + std::to_string(mode.width) + "x" + std::to_string(mode.height) +
           " " + std::to_string(mode.interval_100ns);
}

int print_list()
{
    const V4l2Nodes found = list_v4l2_cameras();
    for (int i = 0; i < found.count; ++i) {
        const V4l2Node& node = found.nodes[static_cast<std::size_t>(i)];
        const CameraIdentity& who = node.identity;
        const UsbPlace place = usb_place_of(who.port.text);
        std::byte descriptors[4096];
        std::printf("camera %s port %s id %04x:%04x serial '%s' name '%s' bus %d speed %d descriptors %zu\n", node.path,
                    who.port.text, who.vendor, who.product, who.serial.text, who.name.text, place.bus,
                    static_cast<int>(place.speed), read_usb_descriptors(who.port.text, descriptors));
    }
    std::printf("cameras %d left_out %d denied %d\n", found.count, found.left_out, found.denied);
    return 0;
}

class Script
{
public:
    explicit Script(std::vector<std::string> words) : words_(std::move(words)) {}

    bool open(const std::string& list)
    {
        for (std::size_t from = 0; from <= list.size();) {
            const std::size_t comma = std::min(list.find(',', from), list.size());
            cameras_.push_back(std::make_unique<V4l2Camera>());
            if (!good(cameras_.back()->open(list.substr(from, comma - from).c_str())))
                return false;
            const CameraIdentity& who = cameras_.back()->identity();
            std::printf("opened %s %s '%s'\n", cameras_.back()->node(), who.port.text, who.name.text);
            from = comma + 1;
        }
        return true;
    }

    void run()
    {
        while (at_ < words_.size()) {
            const std::string action = word();
            if (action == "take")
                take();
            else if (action == "drain")
                drain();
            else if (action == "hold")
                hold(number());
            else if (action == "release")
                release();
            else if (action == "cycles")
                cycles(number());
            else if (action == "wait")
                wait_ms_ = number();
            else if (action == "tries")
                tries_ = number();
            else if (action == "start")
                start();
            else
                simple(action);
            std::fflush(stdout);
        }
    }

private:
    std::string word() { return at_ < words_.size() ? words_[at_++] : std::string{}; }
    int number() { return std::atoi(word().c_str()); }

    void simple(const std::string& action)
    {
        const std::string first = action == "get" || action == "set" || action == "shake" ? word() : "";
        const int value = action == "set" ? number() : 0;
        for (const auto& camera : cameras_)
            if (action == "modes")
                for (const CameraMode& mode : camera->modes())
                    std::printf("mode %s %s\n", camera->identity().port.text, words_of(mode).c_str());
            else if (action == "controls")
                print_controls(*camera);
            else if (action == "get" || action == "set")
                control(*camera, action == "set", first, value);
            else if (action == "stop")
                good(camera->stop()) ? std::printf("stopped %s\n", camera->identity().port.text) : 0;
            else if (action == "shake")
                shake(*camera, first);
            else {
                std::fprintf(stderr, "unknown action '%s'\n", action.c_str());
                std::exit(64);
            }
    }

    static void print_controls(V4l2Camera& camera)
    {
        for (const ControlRange& range : camera.controls()) {
            const Result<std::int32_t> value = camera.get(range.id);
            std::printf("control %s %s %d..%d step %d usual %d", camera.identity().port.text, name_of(range.id),
                        range.least, range.most, range.step, range.usual);
            value.ok() ? std::printf(" is %d\n", value.value()) : std::printf(" unreadable\n");
        }
    }

    static void control(V4l2Camera& camera, bool sets, const std::string& name, int value)
    {
        const std::optional<ControlId> id = control_named(name);
        if (!id) {
            std::fprintf(stderr, "unknown control '%s'\n", name.c_str());
            std::exit(64);
        }
        const Result<std::int32_t> now = sets ? camera.set(*id, value) : camera.get(*id);
        if (good(now.status()))
            std::printf("%s %s %s %d\n", sets ? "set" : "get", camera.identity().port.text, name.c_str(), now.value());
    }

    void shake(V4l2Camera& camera, const std::string& how) const
    {
        const std::int64_t from_us = monotonic_us();
        const Shake step = how == "restart" ? Shake::kRestart : how == "reopen" ? Shake::kReopen : Shake::kPort;
        Status status = camera.shake(step);
        for (int i = 1; i < tries_ && !status.ok(); ++i)
            status = camera.shake(step);
        if (good(status))
            std::printf("shaken %s %s %s in %" PRId64 " ms\n", how.c_str(), camera.identity().port.text, camera.node(),
                        (monotonic_us() - from_us) / 1000);
    }

    void start()
    {
        const std::optional<PixelFormat> format = format_named(word());
        const std::string size = word();
        const int fps = number();
        if (!format || std::sscanf(size.c_str(), "%dx%d", &mode_.width, &mode_.height) != 2 || fps < 1) {
            std::fprintf(stderr, "start FORMAT WIDTHxHEIGHT FPS\n");
            std::exit(64);
        }
        mode_.format = *format;
        mode_.interval_100ns = 10'000'000U / static_cast<unsigned>(fps);
        for (const auto& camera : cameras_)
            if (good(camera->start(mode_)))
                std::printf("started %s %s\n", camera->identity().port.text, words_of(mode_).c_str());
    }

    Result<FrameLease> next(V4l2Camera& camera) const
    {
        return camera.next(monotonic_us() + std::int64_t{wait_ms_} * 1000);
    }

    void take()
    {
        const int frames = number();
        const std::string folder = at_ < words_.size() && words_[at_].find('/') != std::string::npos ? word() : "";
        for (int k = 0; k < frames; ++k)
            for (std::size_t c = 0; c < cameras_.size(); ++c) {
                Result<FrameLease> got = next(*cameras_[c]);
                if (good(got.status()))
                    report(*got.value(), c, k, folder);
            }
    }

    void drain()
    {
        for (std::size_t c = 0; c < cameras_.size(); ++c)
            for (int k = 0; k < kMostDrained; ++k) {
                Result<FrameLease> got = next(*cameras_[c]);
                if (!good(got.status()))
                    break;
                report(*got.value(), c, k, "");
            }
    }

    static void report(const Frame& frame, std::size_t camera, int k, const std::string& folder)
    {
        const std::int64_t age_us = monotonic_us() - frame.start_us;
        std::printf("frame %zu %d %s %zu sequence %u lost %u age_us %" PRId64 " flaw '%s' mode %s\n", camera, k,
                    name_of(frame.verdict), frame.bytes.size(), frame.sequence, frame.lost_before, age_us, frame.flaw,
                    words_of(frame.mode).c_str());
        if (folder.empty())
            return;
        const std::string path =
            folder + "/" + std::to_string(camera) + "-" + std::to_string(k) + "." + name_of(frame.mode.format);
        std::FILE* file = std::fopen(path.c_str(), "wb");
        const bool written =
            file != nullptr && std::fwrite(frame.bytes.data(), 1, frame.bytes.size(), file) == frame.bytes.size();
        if (file == nullptr || std::fclose(file) != 0 || !written) {
            std::fprintf(stderr, "cannot write %s\n", path.c_str());
            std::exit(74);
        }
    }

    static unsigned sum(const Frame& frame)
    {
        unsigned total = 0;
        for (const std::byte byte : frame.bytes)
            total = total * 31 + std::to_integer<unsigned>(byte);
        return total;
    }

    void hold(int frames)
    {
        for (int k = 0; k < frames; ++k)
            for (const auto& camera : cameras_) {
                Result<FrameLease> got = next(*camera);
                if (good(got.status())) {
                    sums_.push_back(sum(*got.value()));
                    held_.push_back(std::move(got).value());
                }
            }
        std::printf("held %zu\n", held_.size());
    }

    void release()
    {
        std::size_t unchanged = 0;
        for (std::size_t i = 0; i < held_.size(); ++i)
            unchanged += sum(*held_[i]) == sums_[i] ? 1U : 0U;
        std::printf("released %zu unchanged %zu\n", held_.size(), unchanged);
        held_.clear();
        sums_.clear();
    }

    void cycles(int count)
    {
        Holdings before;
        int whole = 0;
        std::uint64_t allocated = 0; // by operator new
        const std::int64_t from_us = monotonic_us();
        for (int i = 0; i < count; ++i) {
            for (int twice = 0; i == 10 && twice < 2; ++twice) // the first cycles, and looking, touch what stays
                before = Holdings::now();
            heap_gate::seal(heap_gate::Breach::kCount);
            for (const auto& camera : cameras_) {
                if (!good(camera->start(mode_)))
                    return;
                {
                    const Result<FrameLease> got = next(*camera);
                    whole += good(got.status()) && (*got.value()).verdict == FrameVerdict::kWhole ? 1 : 0;
                }
                good(camera->stop());
            }
            allocated += heap_gate::breaches();
            heap_gate::unseal();
        }
        const Holdings after = Holdings::now();
        std::printf(
            "cycles %d whole %d descriptors %ld %ld maps %ld %ld resident_kib %ld %ld grown %s allocated %" PRIu64
            " in %" PRId64 " ms\n",
            count, whole, before.descriptors, after.descriptors, before.maps, after.maps, before.resident_kib,
            after.resident_kib, after.resident_kib > before.resident_kib + kPagesOfLuckKib ? "yes" : "no", allocated,
            (monotonic_us() - from_us) / 1000);
    }

    std::vector<std::string> words_;
    std::size_t at_ = 0;
    std::vector<std::unique_ptr<V4l2Camera>> cameras_;
    std::vector<FrameLease> held_; // goes before the cameras do
    std::vector<unsigned> sums_;
    CameraMode mode_{PixelFormat::kYuyv, 640, 480, 333333};
    int wait_ms_ = 10000;
    int tries_ = 1;
};

} // namespace

int main(int argc, char** argv)
{
    if (argc >= 2 && std::strcmp(argv[1], "list") == 0)
        return print_list();
    if (argc < 3) {
        std::fprintf(stderr, "usage: %s list | WHERE[,WHERE] ACTION...\n", argv[0]);
        return 64;
    }
    Script script{std::vector<std::string>(argv + 2, argv + argc)};
    if (!script.open(argv[1]))
        return 1;
    script.run();
    return failures == 0 ? 0 : 1;
}
