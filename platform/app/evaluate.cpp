// dicot evaluate: a disparity map against ground truth.
#include "commands.h"
#include "map_judge.h"

#include "dicot/base/arena.h"
#include "dicot/os/memory_block.h"
#include "dicot/picture/read_map.h"
#include "dicot/picture/read_picture.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>
#include <string>

namespace dicot::app {
namespace {

constexpr double kOurPngScale = 256; // of the 16-bit PNG that match writes

constexpr const char* kAbout = "A pixel is judged when its truth is known and the mask counts "
                               "it. bad-N is the share of judged pixels that are off by more than N px; a pixel "
                               "without a disparity counts as bad, "
                               "and is left out of the mean and RMS errors, and of the rates of those with a "
                               "disparity; density is the share that has one. A truth "
                               "that is k times as large as "
                               "the map is taken at the centres of the map's pixels and divided by k.";

struct EvaluateWords
{
    std::string map, truth, mask;
    double scale = 1;
    bool json = false;
};

struct Inputs
{
    MemoryBlock block;
    ImageView<float> map, truth;
    ImageView<Rgb8> mask;
};

template <typename Pixel>
ImageView<Pixel> take(Arena& arena, const PictureSize& size)
{
    return {arena.take<Pixel>(static_cast<std::size_t>(size.pixels())).data(), size.width, size.height};
}

Status check_multiple(const std::string& path, const PictureSize& size, const std::string& map_path,
                      const PictureSize& map)
{
    if (multiple_of(map.width, map.height, size.width, size.height) != 0)
        return {};
    return failure(Fault::kBadData,
                   "%s is %d x %d px, which is no whole multiple of the %d x %d of %s: give those of one pair",
                   path.c_str(), size.width, size.height, map.width, map.height, map_path.c_str());
}

Result<Inputs> read_inputs(const EvaluateWords& words)
{
    const MapHead map = TRY(map_head(words.map.c_str()));
    if (map.kind == MapKind::kPng8)
        return failure(Fault::kBadData, "%s has 8 bits: a disparity map is a PFM, or a PNG of 16 bits with px x 256",
                       words.map.c_str());
    const MapHead truth = TRY(map_head(words.truth.c_str()));
    TRY(check_multiple(words.truth, truth.size, words.map, map.size));
    PictureSize mask;
    if (!words.mask.empty()) {
        mask = TRY(picture_size(words.mask.c_str()));
        TRY(check_multiple(words.mask, mask, words.map, map.size));
    }
    const auto lay_out = [&](Arena& arena, Inputs& inputs) {
        inputs.map = take<float>(arena, map.size);
        inputs.truth = take<float>(arena, truth.size);
        inputs.mask = take<Rgb8>(arena, mask);
    };
    Inputs inputs;
    Arena measuring;
    lay_out(measuring, inputs);
    inputs.block = TRY(MemoryBlock::map(measuring.peak()));
    Arena arena(inputs.block.bytes());
    lay_out(arena, inputs);
    TRY(read_map(words.map.c_str(), kOurPngScale, inputs.map));
    TRY(read_map(words.truth.c_str(), words.scale, inputs.truth));
    if (!words.mask.empty())
        TRY(read_picture(words.mask.c_str(), inputs.mask));
    return inputs;
}

void print_json(const EvaluateWords& words, const MapJudgement& found)
{
    const auto where_valued = [&](double error) { return found.valued > 0 ? nlohmann::json(error) : nlohmann::json(); };
    nlohmann::json bad;
    for (std::size_t i = 0; i < kBadThresholdsPx.size(); ++i)
        bad.push_back({{"threshold_px", kBadThresholdsPx[i]},
                       {"percent", 100 * found.bad_share(i)},
                       {"percent_of_valued", where_valued(100 * found.wrong_share(i))}});
    const nlohmann::json report = {{"map", words.map},
                                   {"truth", words.truth},
                                   {"judged_pixels", found.judged},
                                   {"density", found.density()},
                                   {"bad", bad},
                                   {"mean_error_px", where_valued(found.mean_error_px)},
                                   {"rms_error_px", where_valued(found.rms_error_px)}};
    std::printf("%s\n", report.dump(2).c_str());
}

void print(const EvaluateWords& words, const MapJudgement& found)
{
    std::printf("%s: %lld pixels judged, %.2f %% of them have a disparity\n", words.map.c_str(),
                static_cast<long long>(found.judged), 100 * found.density());
    for (std::size_t i = 0; i < kBadThresholdsPx.size(); ++i) {
        std::printf("bad-%-4g %6.2f %%", kBadThresholdsPx[i], 100 * found.bad_share(i));
        if (found.valued > 0)
            std::printf("   %6.2f %% of those with a disparity", 100 * found.wrong_share(i));
        std::printf("\n");
    }
    if (found.valued > 0)
        std::printf("mean error %.3f px, RMS error %.3f px\n", found.mean_error_px, found.rms_error_px);
}

Status run(const EvaluateWords& words)
{
    const Inputs inputs = TRY(read_inputs(words));
    const MapJudgement found = judge_map(inputs.map, inputs.truth, inputs.mask);
    if (found.judged == 0)
        return failure(Fault::kBadData,
                       "%s: no pixel can be judged: the truth is unknown, or the mask black, everywhere",
                       words.truth.c_str());
    if (words.json)
        print_json(words, found);
    else
        print(words, found);
    return {};
}

} // namespace

void add_evaluate(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("evaluate", "Error rates of a disparity map against ground truth");
    command->footer(kAbout);
    auto words = std::make_shared<EvaluateWords>();
    command->add_option("DISPARITY", words->map, "disparity map: .pfm, or 16-bit .png (px x 256, 0 = missing)")
        ->required();
    command->add_option("GT", words->truth, "ground truth: grey PNG of 8 or 16 bits (0 = unknown), or PFM")->required();
    command->add_option("--mask", words->mask, "picture that is white (255) where a pixel counts");
    command->add_option("--scale", words->scale, "what a PNG's ground truth is divided by")
        ->check(CLI::Range(1e-3, 1e5))
        ->capture_default_str();
    command->add_flag("--json", words->json, "report as JSON");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
