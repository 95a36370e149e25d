// dicot match: a rectified pair in, a disparity map out.
#include "commands.h"
#include "distinct_files.h"
#include "match_bench.h"
#include "match_words.h"
#include "progress.h"
#include "sealed_heap.h"

#include "dicot/os/clock.h"
#include "dicot/os/output_file.h"
#include "dicot/os/process_memory.h"
#include "dicot/os/thread_crew.h"
#include "dicot/picture/read_picture.h"
#include "dicot/picture/write_picture.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <limits>
#include <memory>

namespace dicot::app {
namespace {

struct MatchCommandWords
{
    std::string left, right, output;
    MatchWords match;
    bool json = false;
};

enum class MapFormat
{
    kPfm,
    kPng16
};

constexpr int kPngScale = 256;
constexpr int kPngLargest = 65535;

Result<MapFormat> format_of(const std::string& path)
{
    const auto ends_with = [&](const char* ending) { return CLI::detail::to_lower(path).ends_with(ending); };
    if (ends_with(".pfm"))
        return MapFormat::kPfm;
    if (ends_with(".png"))
        return MapFormat::kPng16;
    return failure(Fault::kUsage, "%s: the name must end in .pfm or .png", path.c_str());
}

/// `options` have passed Matcher::check().
Status check_holds(const std::string& path, MapFormat format, const MatchOptions& options)
{
    if (format == MapFormat::kPng16 &&
        (options.min_disparity < 0 || (options.min_disparity + options.disparities) * kPngScale > kPngLargest))
        return failure(Fault::kUsage, "%s: a 16-bit PNG holds disparities from 0 to 255 px: write a .pfm",
                       path.c_str());
    return {};
}

Status write_map(const std::string& path, MapFormat format, const DisparityMap& map, ImageView<std::uint16_t> scratch)
{
    if (format == MapFormat::kPfm)
        return write_pfm(path.c_str(), map.relative.width, map.relative.height, [&](int y, std::span<float> row) {
            for (int x = 0; x < map.relative.width; ++x) {
                const DispQ8 d = map.relative.row(y)[x];
                row[static_cast<std::size_t>(x)] =
                    d == kDispMissing ? std::numeric_limits<float>::infinity()
                                      : static_cast<float>(map.min_disparity) + static_cast<float>(d) / kPngScale;
            }
        });
    for (int y = 0; y < scratch.height; ++y) {
        for (int x = 0; x < scratch.width; ++x) {
            // 0 means missing, so a disparity of exactly 0 becomes the least value there is.
            const int d = map.relative.row(y)[x];
            scratch.row(y)[x] =
                static_cast<std::uint16_t>(d == kDispMissing ? 0 : std::max(map.min_disparity * kPngScale + d, 1));
        }
    }
    return write_png16(path.c_str(), scratch);
}

double density(const DisparityMap& map)
{
    std::int64_t valued = 0;
    for (int y = 0; y < map.relative.height; ++y)
        for (int x = 0; x < map.relative.width; ++x)
            valued += map.relative.row(y)[x] != kDispMissing;
    return static_cast<double>(valued) / (static_cast<double>(map.relative.width) * map.relative.height);
}

Status run(const MatchCommandWords& words)
{
    const MatchOptions options = words.match.resolved();
    const MapFormat format = TRY(format_of(words.output));
    TRY(check_distinct({words.left, words.right}, {words.output}));
    const Kernels* kernels = TRY(choose_kernels(words.match.cpu));
    const PictureSize size = TRY(picture_size(words.left.c_str()));
    const PictureSize other = TRY(picture_size(words.right.c_str()));
    if (size.width != other.width || size.height != other.height)
        return failure(Fault::kBadData, "%s is %d x %d px and %s is %d x %d: both pictures of a pair have one size",
                       words.left.c_str(), size.width, size.height, words.right.c_str(), other.width, other.height);
    const Status fits = Matcher::check(size.width, size.height, options);
    if (fits.fault() == Fault::kBadData)
        return failure(Fault::kBadData, "%s: %s", words.left.c_str(), fits.message());
    TRY(fits);
    TRY(check_holds(words.output, format, options));
    {
        OutputFile can_be_written;
        TRY(can_be_written.open(words.output.c_str()));
    }
    const int threads = words.match.resolved_threads();
    MatchBench bench = TRY(MatchBench::make(size.width, size.height, options, *kernels, threads));
    TRY(read_picture(words.left.c_str(), bench.left));
    TRY(read_picture(words.right.c_str(), bench.right));

    ThreadCrew crew(threads);
    TRY(crew.started());
    const std::int64_t start = monotonic_us();
    MatchOutcome outcome{};
    double seconds = 0;
    {
        const SealedHeap sealed;
        {
            Progress progress("matching");
            outcome = bench.matcher.match(bench.left, bench.right, crew, {nullptr, Progress::rows_done, &progress});
        }
        seconds = static_cast<double>(monotonic_us() - start) * 1e-6;
        TRY(write_map(words.output, format, outcome.map, bench.output));
    }

    const double terms_per_s = static_cast<double>(bench.matcher.terms()) / seconds;
    const ProcessMemory memory = TRY(process_memory());
    if (words.json) {
        const nlohmann::json report = {{"output", words.output},
                                       {"width", size.width},
                                       {"height", size.height},
                                       {"min_disparity_px", options.min_disparity},
                                       {"disparities", options.disparities},
                                       {"method", words.match.method},
                                       {"cost", words.match.cost},
                                       {"dense", options.dense},
                                       {"window_px", options.window},
                                       {"kernels", kernels->name},
                                       {"threads", threads},
                                       {"match_s", seconds},
                                       {"terms_per_s", terms_per_s},
                                       {"density", density(outcome.map)},
                                       {"peak_memory_bytes", memory.peak_bytes}};
        std::printf("%s\n", report.dump(2).c_str());
    } else {
        std::printf("%s: %d x %d px, %.1f %% of the pixels have a disparity\n", words.output.c_str(), size.width,
                    size.height, 100 * density(outcome.map));
        std::printf("matched in %.2f s (%s, %d threads, %.3g terms/s), peak memory %.1f MiB\n", seconds, kernels->name,
                    threads, terms_per_s, static_cast<double>(memory.peak_bytes) / (1 << 20));
    }
    return {};
}

} // namespace

void add_match(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("match", "Disparity map of a rectified stereo pair");
    auto words = std::make_shared<MatchCommandWords>();
    command->add_option("LEFT", words->left, "left picture: PNG, JPEG or PPM, rectified")->required();
    command->add_option("RIGHT", words->right, "right picture, of the same size")->required();
    command
        ->add_option("-o,--output", words->output,
                     "disparity map: .pfm (float32, missing = +inf) or .png (16 bit, px x 256, 0 = missing)")
        ->required();
    command->add_option("--disparities", words->match.options.disparities, "width of the search range, px")
        ->capture_default_str();
    command->add_option("--min-disparity", words->match.options.min_disparity, "start of the search range, px")
        ->capture_default_str();
    command->add_flag("--dense", words->match.options.dense,
                      "give every pixel a value, if need be from its neighbours");
    words->match.add_to(*command);
    command->add_flag("--json", words->json, "report as JSON");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
