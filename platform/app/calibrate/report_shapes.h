// What the drawings of a report are made of: SVG without a script, colours by the classes of report_style.h.
#pragma once

#include <string>

namespace dicot::app::svg {

/// A coordinate, with one decimal.
std::string at(double value);

/// The opening of a drawing; `label` says what it shows, for those who hear it.
std::string begin(double width, double height, const std::string& label);
std::string words(double x, double y, const char* kind, const std::string& text);
std::string line(double x0, double y0, double x1, double y1, const char* kind);
std::string box(double x, double y, double width, double height, const char* kind, const std::string& title = "");

/// A dot each, as strokes without length.
class Dots
{
public:
    void add(double x, double y);
    std::string drawn(const char* kind) const;

private:
    std::string path_;
};

/// A mark of a scale (1, 2, 2.5 or 5 times a power of ten) with as many decimals as it needs.
std::string mark_of(double value);

/// 1, 2 or 5 times a power of ten, the least that is not below `value` > 0.
double round_up(double value);

/// A whole drawing as a file of its own, with the style in it.
std::string standalone(std::string drawing);

} // namespace dicot::app::svg
