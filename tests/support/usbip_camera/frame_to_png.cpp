// The pixels of a YUYV frame as the driver's reader decodes them, for programs that take files.
//
//   frame_to_png FRAME.yuyv WIDTHxHEIGHT PICTURE.png
#include "dicot/camera/decode_frame.h"
#include "dicot/picture/write_picture.h"

#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

namespace {

using namespace dicot;

Status run(const char* from, const char* size, const char* to)
{
    Frame frame;
    frame.mode = {PixelFormat::kYuyv, 0, 0, 333333};
    if (std::sscanf(size, "%5dx%5d", &frame.mode.width, &frame.mode.height) != 2)
        return failure(Fault::kUsage, "'%s' should be WIDTHxHEIGHT", size);
    std::ifstream file(from, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
    if (!file)
        return failure(Fault::kNoInput, "%s: cannot be read", from);
    frame.bytes = std::as_bytes(std::span{bytes});
    frame.verdict = FrameVerdict::kWhole;
    TRY(check_frame(frame)); // before its size is believed
    std::vector<Rgb8> pixels(static_cast<std::size_t>(frame.mode.width) * static_cast<std::size_t>(frame.mode.height));
    const ImageView<Rgb8> picture{pixels.data(), frame.mode.width, frame.mode.height};
    TRY(decode_frame(frame, picture));
    return write_png(to, picture);
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 4) {
        std::fprintf(stderr, "usage: %s FRAME.yuyv WIDTHxHEIGHT PICTURE.png\n", argv[0]);
        return 64;
    }
    const dicot::Status status = run(argv[1], argv[2], argv[3]);
    if (!status.ok())
        std::fprintf(stderr, "frame_to_png: %s\n", status.message());
    return status.exit_code();
}
