#include "kernel_proof.h"

#include <algorithm>

namespace dicot::proof {
namespace {

struct Call
{
    int n, cell_log2;
    RemapSource source;
    std::span<std::uint8_t> pixels;
    std::span<RemapSpan> spans;
    Twin<std::uint8_t> out;

    Call(Stand& stand, int count, int cell, int width, int height, int padding)
        : n(count), cell_log2(cell), source{nullptr, 3 * width + padding, width, height},
          pixels(stand.input<std::uint8_t>(static_cast<std::size_t>((height - 1) * source.stride_bytes + 3 * width))),
          spans(stand.input<RemapSpan>(static_cast<std::size_t>((n + (1 << cell) - 1) >> cell))),
          out(stand.output<std::uint8_t>(static_cast<std::size_t>(3 * n)))
    {
        source.rgb = pixels.data();
    }
    void run(const Kernels& kernels, std::span<std::uint8_t> to) const
    {
        kernels.remap_row(to.data(), n, spans.data(), cell_log2, source);
    }
};

constexpr std::int32_t px(double value)
{
    return static_cast<std::int32_t>(value * (1 << kRemapFraction));
}

void work(const Kernels& tested, Stand& stand, Verdict& verdict)
{
    // Red of the 3 x 2 picture is 0 100 200 over 255 51 1; green is 255 less red, blue is 7.
    constexpr std::uint8_t kRed[] = {0, 100, 200, 255, 51, 1};
    struct Vector
    {
        double x, y;
        int red; // -1: outside
    };
    constexpr Vector kVectors[] = {
        {0, 0, 0},
        {1, 0, 100},
        {2, 0, 200},
        {0, 1, 255},
        {2, 1, 1}, // the last pixel, whole
        {0.5, 0, 50},
        {1.5, 1, 26},
        {0, 0.5, 128},           // 127.5 is rounded up
        {0.5, 0.5, 102},         // (0 + 100 + 255 + 51) / 4 = 101.5
        {1 + 1.0 / 128, 0, 101}, // 100.78
        {1 + 0.4 / 128, 0, 100}, // less than half a step of the weights
        {1 + 0.5 / 128, 0, 101}, // half a step is a step
        {-0.5 / 128, 0, 0},      // rounds to the first column
        {-0.6 / 128, 0, -1},
        {2 + 0.4 / 128, 0, 200},
        {2 + 0.5 / 128, 0, -1},
        {0, -0.6 / 128, -1},
        {0, 1 + 0.5 / 128, -1},
        {-8000, 9000, -1},
    };
    for (const Vector& vector : kVectors) {
        constexpr int kCount = 7; // a vector of four, and some left over
        stand.begin(Placement::kLast);
        Call call(stand, kCount, 3, 3, 2, 0);
        for (std::size_t i = 0; i < 6; ++i) {
            call.pixels[3 * i] = kRed[i];
            call.pixels[3 * i + 1] = static_cast<std::uint8_t>(255 - kRed[i]);
            call.pixels[3 * i + 2] = 7;
        }
        call.spans[0] = {px(vector.x), px(vector.y), 0, 0};
        if (const char* words = stand.trespass([&](int) { call.run(tested, call.out.tested); }); words[0] != 0)
            note_fault(verdict, "worked vector %d: %s", verdict.worked, words);
        for (std::size_t i = 0; i < kCount; ++i) {
            const int red = call.out.tested[3 * i];
            const int blue = call.out.tested[3 * i + 2];
            if (red != std::max(vector.red, 0) || blue != (vector.red < 0 ? 0 : 7))
                note_fault(verdict, "worked vector %d: red at (%g, %g) is %d and blue %d, right is %d", verdict.worked,
                           vector.x, vector.y, red, blue, vector.red);
        }
        ++verdict.worked;
    }
    // The position moves within a cell: columns 0, 0.25, 0.5 ... of a row that rises by 100 a pixel.
    stand.begin(Placement::kFirst);
    Call call(stand, 8, 3, 3, 2, 0);
    std::ranges::fill(call.pixels, std::uint8_t{0});
    for (std::size_t i = 0; i < 6; ++i)
        call.pixels[3 * i] = static_cast<std::uint8_t>(i % 3 * 100);
    call.spans[0] = {0, 0, px(0.25), px(0.125)};
    call.run(tested, call.out.tested);
    for (std::size_t i = 0; i < 8; ++i)
        if (call.out.tested[3 * i] != 25 * i)
            note_fault(verdict, "worked vector %d: pixel %zu of a ramp is %d, right is %zu", verdict.worked, i,
                       call.out.tested[3 * i], 25 * i);
    ++verdict.worked;
}

enum class Path
{
    kAnywhere, ///< as likely outside as inside
    kBorder,   ///< within two steps of the weights of the picture's border
    kSmooth,   ///< as a real table's, inside
    kFar,      ///< the largest positions of the domain
};

std::int32_t start_on(Dice& dice, Path path, int side)
{
    const int last = (side - 1) << kRemapFraction;
    switch (path) {
    case Path::kAnywhere:
        return dice.between(-last / 2 - 1000, last + last / 2 + 1000);
    case Path::kBorder:
        return (dice.up_to(1) != 0 ? last : 0) + dice.between(-1100, 1100);
    case Path::kSmooth:
        return dice.between(0, last);
    case Path::kFar:
        return dice.up_to(1) != 0 ? 0x7FFFFEFF : -0x7FFFFEFF;
    }
    return 0;
}

void fill(Call& call, Dice& dice, Path path, Filling filling)
{
    for (std::uint8_t& value : call.pixels)
        value = static_cast<std::uint8_t>(draw(dice, filling, 255));
    for (RemapSpan& span : call.spans) {
        span = {start_on(dice, path, call.source.width), start_on(dice, path, call.source.height), 0, 0};
        const int most = path == Path::kBorder ? 300 : path == Path::kSmooth ? 70'000 : 4'000'000;
        if (path != Path::kFar) {
            span.dx = dice.between(-most, most);
            span.dy = dice.between(-most, most);
        }
    }
}

void compare(const Kernels& tested, Stand& stand, Dice& dice, Verdict& verdict)
{
    const auto run_case = [&](int n, int width, int height, Path path, Filling filling, Placement placement) {
        stand.begin(placement);
        Call call(stand, n, dice.between(2, 3), width, height, dice.between(0, 5));
        fill(call, dice, path, filling);
        const char* words = stand.difference([&](int) { call.run(kScalarKernels, call.out.law); },
                                             [&](int) { call.run(tested, call.out.tested); });
        if (words[0] != 0)
            note_fault(verdict, "%d pixels from %d x %d, path %d, pixels %s, %s: %s", n, width, height,
                       static_cast<int>(path), word_for(filling), word_for(placement), words);
        ++verdict.compared;
    };
    for (const Placement placement : kPlacements)
        for (const Path path : {Path::kAnywhere, Path::kBorder, Path::kSmooth, Path::kFar}) {
            for (int n = 0; n <= 97; ++n)
                run_case(n, dice.between(3, 40), dice.between(2, 20), path, Filling::kRandom, placement);
            for (const Filling filling : kFillings)
                run_case(1281, dice.between(3, 500), dice.between(2, 300), path, filling, placement);
        }
}

double time(const Kernels& tested, Stand& stand)
{
    constexpr int kWidth = 1280;
    Dice dice{1};
    stand.begin(Placement::kFirst);
    Call call(stand, kWidth, 3, kWidth, 8, 0);
    fill(call, dice, Path::kSmooth, Filling::kRandom);
    for (std::size_t i = 0; i < call.spans.size(); ++i)
        call.spans[i] = {static_cast<std::int32_t>(i * 8 * 65'000), px(3.3), 65'000, 40};
    return best_rate(kWidth, [&](int) { call.run(tested, call.out.tested); });
}

} // namespace

const KernelProof kRemapProof = {
    "remap_row", "pixels", [](const Kernels& a, const Kernels& b) { return a.remap_row == b.remap_row; },
    work,        compare,  time};

} // namespace dicot::proof
