#include "raw_depth.h"

#include "dicot/picture/read_map.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace dicot::test {
namespace {

struct GreyMap
{
    PictureSize size;
    std::vector<float> values; ///< infinite where the file has 0
};

GreyMap read_grey(const std::string& path, double scale)
{
    const auto stop_on = [](const Status& status) {
        if (status.ok())
            return;
        std::fprintf(stderr, "%s\n", status.message());
        std::exit(status.exit_code());
    };
    const auto head = map_head(path.c_str());
    stop_on(head.status());
    GreyMap map{head.value().size, {}};
    map.values.resize(static_cast<std::size_t>(map.size.pixels()));
    stop_on(read_map(path.c_str(), scale, {map.values.data(), map.size.width, map.size.height}));
    return map;
}

double median_of(std::vector<float>& values)
{
    if (values.empty())
        return NAN;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return static_cast<double>(*middle);
}

} // namespace

TrueDepth read_truth(const std::string& folder, const std::string& seen_name)
{
    constexpr double kStepsInMm = 10;
    constexpr float kBoth = 255, kLeftOnly = 128;
    GreyMap depth = read_grey(folder + "/gt_depth.png", kStepsInMm);
    const GreyMap kind = read_grey(folder + "/gt_class.png", 1);
    const GreyMap seen = read_grey(folder + "/" + seen_name, 1);
    TrueDepth truth{depth.size.width, depth.size.height, std::move(depth.values), {}, {}, {}, {}};
    for (std::size_t i = 0; i < truth.pixels(); ++i) {
        const float k = kind.values[i];
        truth.kind.push_back(std::isfinite(k) ? static_cast<Kind>(k) : Kind::kBackground);
        truth.seen_by_both.push_back(seen.values[i] == kBoth);
        truth.hidden.push_back(seen.values[i] == kLeftOnly);
        truth.leaf.push_back(truth.kind[i] == Kind::kLeaf && truth.seen_by_both[i] && std::isfinite(truth.mm[i]));
    }
    return truth;
}

DepthFigures figures_of(const RawDepth& measured, const TrueDepth& truth, const std::vector<bool>& mask)
{
    DepthFigures f;
    std::vector<float> signed_errors, errors;
    long within = 0, off = 0;
    for (std::size_t i = 0; i < truth.pixels(); ++i) {
        if (!mask[i])
            continue;
        ++f.pixels;
        if (std::isnan(measured.mm[i]))
            continue;
        const float error = measured.mm[i] - truth.mm[i];
        signed_errors.push_back(error);
        errors.push_back(std::fabs(error));
        within += errors.back() <= float{DepthFigures::kWithinMm};
        off += errors.back() > float{DepthFigures::kOffMm};
    }
    const auto percent = [](auto part, auto whole) {
        return 100 * static_cast<double>(part) / static_cast<double>(whole);
    };
    f.median_mm = median_of(errors);
    f.bias_mm = median_of(signed_errors);
    f.valued = percent(errors.size(), f.pixels);
    f.within_all = percent(within, f.pixels);
    f.within_valued = percent(within, errors.size());
    f.off_all = percent(off, f.pixels);
    f.off_valued = percent(off, errors.size());
    return f;
}

DepthFigures mean_of(const std::vector<DepthFigures>& all)
{
    DepthFigures mean;
    const auto n = static_cast<double>(all.size());
    for (const DepthFigures& f : all) {
        mean.pixels += f.pixels;
        mean.median_mm += f.median_mm / n;
        mean.bias_mm += f.bias_mm / n;
        mean.valued += f.valued / n;
        mean.within_all += f.within_all / n;
        mean.within_valued += f.within_valued / n;
        mean.off_all += f.off_all / n;
        mean.off_valued += f.off_valued / n;
    }
    return mean;
}

void print_head()
{
    std::printf("| %-22s | %-4s | %7s | %6s | %6s | %7s | %14s | %14s |\n", "leaf pixels", "who", "pixels", "median",
                "bias", "valued", "within 3 mm", "off > 10 mm");
    std::printf("| %-22s | %-4s | %7s | %6s | %6s | %7s | %6s  %6s | %6s  %6s |\n", "", "", "", "mm", "mm", "%",
                "% all", "valued", "% all", "valued");
}

void print_row(const char* name, const char* who, const DepthFigures& f)
{
    std::printf("| %-22s | %-4s | %7ld | %6.2f | %6.2f | %7.2f | %6.2f  %6.2f | %6.2f  %6.2f |\n", name, who, f.pixels,
                f.median_mm, f.bias_mm, f.valued, f.within_all, f.within_valued, f.off_all, f.off_valued);
    std::fflush(stdout);
}

} // namespace dicot::test
