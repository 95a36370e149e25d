#include "report_shapes.h"

#include "report_style.h"
#include "report_text.h"

#include <cmath>

namespace dicot::app::svg {

std::string at(double value)
{
    return fixed(value, 1);
}

std::string begin(double width, double height, const std::string& label)
{
    return fill(R"(<svg viewBox="0 0 {} {}" role="img" aria-label="{}">)", {at(width), at(height), escaped(label)});
}

std::string words(double x, double y, const char* kind, const std::string& text)
{
    return fill(R"(<text x="{}" y="{}" class="{}">{}</text>)", {at(x), at(y), kind, text});
}

std::string line(double x0, double y0, double x1, double y1, const char* kind)
{
    return fill(R"(<path class="{}" d="M{} {}L{} {}"/>)", {kind, at(x0), at(y0), at(x1), at(y1)});
}

std::string box(double x, double y, double width, double height, const char* kind, const std::string& title)
{
    return fill(R"(<rect class="{}" x="{}" y="{}" width="{}" height="{}">{}</rect>)",
                {kind, at(x), at(y), at(width), at(height), title.empty() ? "" : "<title>" + title + "</title>"});
}

void Dots::add(double x, double y)
{
    path_ += fill("M{} {}h0", {at(x), at(y)});
}

std::string Dots::drawn(const char* kind) const
{
    return path_.empty() ? "" : fill(R"(<path class="{}" d="{}"/>)", {kind, path_});
}

std::string mark_of(double value)
{
    int decimals = 0;
    for (double size = value; decimals < 6 && std::abs(size - std::floor(size + 0.5)) > 1e-6; size *= 10)
        ++decimals;
    return fixed(value, decimals);
}

double round_up(double value)
{
    double step = 1e-6;
    while (5 * step < value)
        step *= 10;
    return value <= step ? step : value <= 2 * step ? 2 * step : 5 * step;
}

std::string standalone(std::string drawing)
{
    drawing.insert(drawing.find('>') + 1,
                   std::string("<style>") + kReportStyle + "svg { background: var(--paper); }\n</style>");
    drawing.insert(drawing.find("<svg") + 4, " xmlns=\"http://www.w3.org/2000/svg\"");
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + drawing;
}

} // namespace dicot::app::svg
