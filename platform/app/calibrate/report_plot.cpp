#include "report_plot.h"

#include "report_shapes.h"
#include "report_text.h"

#include <algorithm>
#include <cmath>

namespace dicot::app::svg {
namespace {

constexpr double kLeft = 74, kRight = 24, kTop = 16, kFoot = 34;
constexpr double kAbove = 9; // words over a curve

/// -0.5 of a step and the like are no 0.
std::string scale_mark(double value, double step)
{
    if (std::abs(value) < step * 1e-6)
        return "0";
    return (value < 0 ? "−" : "") + mark_of(std::abs(value));
}

} // namespace

Scale Scale::around(double from, double to, int marks, std::string unit)
{
    Scale scale;
    scale.step = round_up((to - from) / marks);
    scale.from = scale.step * std::floor(from / scale.step + 1e-9);
    scale.to = scale.step * std::ceil(to / scale.step - 1e-9);
    scale.unit = std::move(unit);
    return scale;
}

Plot::Plot(double width, double height, Scale x, Scale y, const std::string& label)
    : width_(width), height_(height), x_(std::move(x)), y_(std::move(y)), head_(begin(width, height, label))
{
    const double foot = height_ - kFoot;
    const auto marks = [](const Scale& s) { return static_cast<int>(std::lround((s.to - s.from) / s.step)); };
    for (int k = 0; k <= marks(y_); ++k) {
        const double value = y_.from + k * y_.step;
        const bool zero = std::abs(value) < 1e-6 * y_.step;
        inner_ += line(kLeft, y_of(value), width_ - kRight, y_of(value), zero ? "axis" : "grid");
        inner_ += words(kLeft - 8, y_of(value) + 4, "label end",
                        scale_mark(value, y_.step) + (k == marks(y_) ? " " + y_.unit : ""));
    }
    for (const auto& [value, text] : x_.named) {
        inner_ += line(x_of(value), foot, x_of(value), foot + 5, "axis");
        inner_ += words(x_of(value), foot + 20, "label middle", escaped(text));
    }
    for (int k = 0; x_.named.empty() && k <= marks(x_); ++k) {
        const double value = x_.from + k * x_.step;
        inner_ += line(x_of(value), foot, x_of(value), foot + 5, "axis");
        inner_ += words(x_of(value), foot + 20, k == marks(x_) ? "label end" : "label middle",
                        scale_mark(value, x_.step) + (k == marks(x_) ? " " + x_.unit : ""));
    }
}

double Plot::x_of(double value) const
{
    return kLeft + (value - x_.from) / (x_.to - x_.from) * (width_ - kLeft - kRight);
}

double Plot::y_of(double value) const
{
    const double shown = std::clamp(value, y_.from, y_.to);
    return height_ - kFoot - (shown - y_.from) / (y_.to - y_.from) * (height_ - kFoot - kTop);
}

std::string Plot::path(std::span<const PlotPoint> points) const
{
    std::string d;
    for (const auto& [x, y] : points)
        d += fill("{}{} {}", {d.empty() ? "M" : "L", at(x_of(x)), at(y_of(y))});
    return d;
}

void Plot::curve(std::span<const PlotPoint> points, const char* kind)
{
    inner_ += fill(R"(<path class="{}" d="{}"/>)", {kind, path(points)});
}

void Plot::band(std::span<const PlotPoint> lower, std::span<const PlotPoint> upper, const char* kind)
{
    std::vector<PlotPoint> around(lower.begin(), lower.end());
    around.insert(around.end(), upper.rbegin(), upper.rend());
    inner_ += fill(R"(<path class="{}" d="{}Z"/>)", {kind, path(around)});
}

void Plot::dots(std::span<const PlotPoint> points, const char* kind)
{
    Dots drawn;
    for (const auto& [x, y] : points)
        drawn.add(x_of(x), y_of(y));
    inner_ += drawn.drawn(kind);
}

void Plot::rings(std::span<const PlotPoint> points, const char* kind)
{
    for (const auto& [x, y] : points)
        inner_ += fill(R"(<circle class="{}" cx="{}" cy="{}" r="4"/>)", {kind, at(x_of(x)), at(y_of(y))});
}

void Plot::stripe(double from_x, double to_x, const char* kind, const std::string& title)
{
    inner_ += box(x_of(from_x), kTop, x_of(to_x) - x_of(from_x), height_ - kFoot - kTop, kind, escaped(title));
}

void Plot::reach(double x, double low, double high, const char* kind)
{
    inner_ += line(x_of(x), y_of(low), x_of(x), y_of(high), kind);
}

void Plot::note(double x, double y, const char* kind, const std::string& text)
{
    inner_ += words(x_of(x), y_of(y) - kAbove, kind, escaped(text));
}

std::string Plot::drawn() const
{
    return head_ + inner_ + "</svg>\n";
}

} // namespace dicot::app::svg
