// Curves and dots over two scales, as inline SVG.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace dicot::app::svg {

/// The part of a scale that a plot shows, from a mark to a mark.
struct Scale
{
    double from = 0;
    double to = 1;
    double step = 1; ///< between marks
    std::string unit;
    std::vector<std::pair<double, std::string>> named{}; ///< marks with words of their own, instead of the steps

    /// Holds both values, with about `marks` steps of 1, 2 or 5 times a power of ten. `from` < `to`.
    static Scale around(double from, double to, int marks, std::string unit);
};

using PlotPoint = std::pair<double, double>;

/// A frame with marks, and what is drawn into it. Classes as in report_style.h.
class Plot
{
public:
    Plot(double width, double height, Scale x, Scale y, const std::string& label);

    double x_of(double value) const;
    double y_of(double value) const;

    void curve(std::span<const PlotPoint> points, const char* kind);
    /// The area between two curves over the same places.
    void band(std::span<const PlotPoint> lower, std::span<const PlotPoint> upper, const char* kind);
    void dots(std::span<const PlotPoint> points, const char* kind);
    /// Hollow dots.
    void rings(std::span<const PlotPoint> points, const char* kind);
    /// From x to x over the whole height, with words for who points at it.
    void stripe(double from_x, double to_x, const char* kind, const std::string& title);
    /// An upright stroke.
    void reach(double x, double low, double high, const char* kind);
    /// Words just above a place of the scales; `kind` "label", "label end" or "label middle".
    void note(double x, double y, const char* kind, const std::string& text);

    std::string drawn() const;

private:
    std::string path(std::span<const PlotPoint> points) const;

    double width_;
    double height_;
    Scale x_;
    Scale y_;
    std::string inner_;
    std::string head_;
};

} // namespace dicot::app::svg
