#include "store_plot.h"

#include "dicot/os/output_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace dicot::bench {
namespace {

constexpr double kWidth = 860;
constexpr double kLeft = 70;
constexpr double kRight = 690;
constexpr double kPanelHeight = 190;

struct Line
{
    const char* name;
    const char* colour;
    double StoreBlock::*value;
};

std::string printed(const char* format, double a, double b = 0, double c = 0, double d = 0)
{
    char text[256];
    std::snprintf(text, sizeof text, format, a, b, c, d);
    return text;
}

std::string label(double x, double y, const char* anchor, const std::string& words, const char* colour = "#333")
{
    return printed("<text x=\"%.1f\" y=\"%.1f\" ", x, y) + "text-anchor=\"" + anchor + "\" fill=\"" + colour + "\">" +
           words + "</text>\n";
}

/// A step of 1, 2 or 5 times a power of ten, of which four or five reach `most`.
double step_for(double most)
{
    const double power = std::pow(10, std::floor(std::log10(most / 4)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (most / (factor * power) <= 5)
            return factor * power;
    return 10 * power;
}

std::string panel(double top, const std::string& heading, const std::vector<Line>& lines,
                  const std::vector<StoreBlock>& blocks)
{
    double most = 1e-3;
    for (const StoreBlock& block : blocks)
        for (const Line& line : lines)
            most = std::max(most, block.*line.value);
    const double step = step_for(most);
    const double ceiling = std::ceil(most / step) * step;
    const double bottom = top + kPanelHeight;
    const auto x_of = [&](double count) { return kLeft + (kRight - kLeft) * count / blocks.back().last; };
    const auto y_of = [&](double value) { return bottom - kPanelHeight * value / ceiling; };

    std::string svg = label(kLeft, top - 10, "start", heading, "#000");
    for (int i = 0; i <= static_cast<int>(std::lround(ceiling / step)); ++i) {
        const double value = i * step;
        svg += printed("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#ddd\"/>\n", kLeft, y_of(value),
                       kRight, y_of(value));
        svg += label(kLeft - 8, y_of(value) + 4, "end", printed("%g", value));
    }
    for (int part = 0; part <= 4; ++part)
        svg += label(x_of(blocks.back().last * part / 4.0), bottom + 18, "middle",
                     printed("%.0f", blocks.back().last * part / 4.0));
    double above = 1e9; // names of lines that end near each other stand below each other
    std::vector<Line> by_height = lines;
    std::ranges::sort(by_height, {}, [&](const Line& line) { return blocks.back().*line.value; });
    for (const Line& line : by_height) {
        svg += std::string{"<polyline fill=\"none\" stroke-width=\"2\" stroke=\""} + line.colour + "\" points=\"";
        for (const StoreBlock& block : blocks)
            svg += printed("%.1f,%.1f ", x_of(block.last), y_of(block.*line.value));
        svg += "\"/>\n";
        above = std::min(above - 16, y_of(blocks.back().*line.value) + 4);
        svg += label(kRight + 8, above, "start", line.name, line.colour);
    }
    return svg;
}

} // namespace

Status write_store_plot(const std::string& path, const std::string& title, const std::vector<StoreBlock>& blocks)
{
    if (blocks.empty())
        return failure(Fault::kUsage, "%s: nothing to draw", path.c_str());
    const double height = 70 + 3 * (kPanelHeight + 60);
    std::string svg = printed("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" font-size=\"13\" "
                              "font-family=\"sans-serif\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
                              kWidth, height);
    svg += "<g font-size=\"15\">" + label(kLeft, 28, "start", title, "#000") + "</g>\n";
    svg += panel(80, "commit, milliseconds, of 500 each",
                 {{"99th percentile", "#c0392b", &StoreBlock::commit_p99_ms},
                  {"median", "#1f618d", &StoreBlock::commit_median_ms}},
                 blocks);
    svg += panel(80 + kPanelHeight + 60, "processor time of a whole snapshot, milliseconds",
                 {{"median", "#1f618d", &StoreBlock::cpu_median_ms}}, blocks);
    svg += panel(80 + 2 * (kPanelHeight + 60), "memory, MiB",
                 {{"the whole process", "#6c3483", &StoreBlock::resident_mib},
                  {"SQLite's peak", "#117a65", &StoreBlock::heap_mib}},
                 blocks);
    svg += label((kLeft + kRight) / 2, height - 12, "middle", "snapshots in the store");
    svg += "</svg>\n";
    OutputFile file;
    TRY(file.open(path.c_str()));
    TRY(file.write(svg.data(), svg.size()));
    return file.commit();
}

} // namespace dicot::bench
