// The verdict and the numbers of the report.
#include "report_page.h"
#include "report_text.h"

#include <cmath>
#include <numbers>

namespace dicot::app {
namespace {

using calibration::Verdict;

const char* headline(Verdict verdict)
{
    switch (verdict) {
    case Verdict::kGood:
        return "Good";
    case Verdict::kUsable:
        return "Usable";
    case Verdict::kRedo:
        return "Redo";
    }
    return "";
}

const char* meaning(Verdict verdict)
{
    switch (verdict) {
    case Verdict::kGood:
        return "This calibration can be trusted in millimetres.";
    case Verdict::kUsable:
        return "You can measure with this calibration, within the errors below. More pictures make it better.";
    case Verdict::kRedo:
        return "Do not measure with this calibration. Take the pictures again, as below.";
    }
    return "";
}

/// The sentence as one of its own.
std::string sentence(const std::string& advice)
{
    std::string text = advice;
    if (!text.empty() && text.front() >= 'a' && text.front() <= 'z')
        text.front() = static_cast<char>(text.front() - 'a' + 'A');
    return escaped(text) + (text.empty() || text.back() == '.' || text.back() == '?' ? "" : ".");
}

std::string with_deviation(double value, double deviation, int decimals)
{
    return deviation > 0 ? fill("{} ± {}", {fixed(value, decimals), fixed(deviation, decimals)})
                         : fixed(value, decimals);
}

std::string row(const char* what, const std::string& value, const std::string& means)
{
    return fill("<tr><th scope=\"row\">{}</th><td class=\"number\">{}</td><td class=\"means\">{}</td></tr>\n",
                {what, value, means});
}

std::string up_to(const calibration::Gate<double>& gate, const char* unit)
{
    return fill("Good up to {} {}, usable up to {} {}.", {fixed(gate.good, 2), unit, fixed(gate.usable, 2), unit});
}

std::string lens_table(const CalibrationRun& run)
{
    const calibration::StereoCalibration& c = run.calibration;
    struct Number
    {
        const char* name;
        double left, right;
        int decimals;
    };
    const Lens& l = c.rig.left;
    const Lens& r = c.rig.right;
    const std::array<Number, 9> numbers{{{"fx, px", l.fx, r.fx, 2},
                                         {"fy, px", l.fy, r.fy, 2},
                                         {"cx, px", l.cx, r.cx, 2},
                                         {"cy, px", l.cy, r.cy, 2},
                                         {"k1", l.k[0], r.k[0], 5},
                                         {"k2", l.k[1], r.k[1], 5},
                                         {"p1", l.k[2], r.k[2], 5},
                                         {"p2", l.k[3], r.k[3], 5},
                                         {"k3", l.k[4], r.k[4], 5}}};
    std::string html = "<h3>Lenses</h3>\n<table><thead><tr><th></th><th>left</th><th>right</th></tr></thead>"
                       "<tbody>\n";
    for (std::size_t k = 0; k < numbers.size(); ++k) {
        const Number& n = numbers[k];
        html += fill("<tr><th scope=\"row\">{}</th><td class=\"plain\">{}</td><td class=\"plain\">{}</td></tr>\n",
                     {n.name, with_deviation(n.left, c.deviation(static_cast<int>(k)), n.decimals),
                      with_deviation(n.right, c.deviation(static_cast<int>(k + numbers.size())), n.decimals)});
    }
    return html +
           "</tbody></table>\n<p class=\"note\">fx, fy: focal length along rows and columns. cx, cy: where the axis "
           "meets the picture. k1 k2 k3: how straight lines bend, from the middle to the border; a number without ± "
           "was "
           "not fitted. p1 p2: a lens that sits out of centre.</p>\n";
}

std::string rig_table(const CalibrationRun& run)
{
    const calibration::StereoCalibration& c = run.calibration;
    // The turn's rotation vector: its axis times its angle.
    const Turn& m = c.rig.turn;
    const Point3 axis{0.5 * (m[7] - m[5]), 0.5 * (m[2] - m[6]), 0.5 * (m[3] - m[1])};
    const double sine = std::sqrt(axis.x * axis.x + axis.y * axis.y + axis.z * axis.z);
    const double angle = std::atan2(sine, 0.5 * (m[0] + m[4] + m[8] - 1));
    constexpr double kDegrees = 180 / std::numbers::pi;
    const double to_degrees = kDegrees * (sine > 0 ? angle / sine : 1);
    constexpr int kTurn = 18;
    constexpr int kShift = 21;
    const auto entry = [&](const char* name, double value, double deviation, int decimals) {
        return fill("<tr><th scope=\"row\">{}</th><td class=\"plain\">{}</td></tr>\n",
                    {name, with_deviation(value, deviation, decimals)});
    };
    const Point3& s = c.rig.shift_mm;
    return "<h3>From the left to the right camera</h3>\n<table><thead><tr><th></th><th>x_right = R x_left + T</th></tr>"
           "</thead><tbody>\n" +
           entry("T x, mm", s.x, c.deviation(kShift), 3) + entry("T y, mm", s.y, c.deviation(kShift + 1), 3) +
           entry("T z, mm", s.z, c.deviation(kShift + 2), 3) +
           entry("R about x, degrees", to_degrees * axis.x, kDegrees * c.deviation(kTurn), 4) +
           entry("R about y, degrees", to_degrees * axis.y, kDegrees * c.deviation(kTurn + 1), 4) +
           entry("R about z, degrees", to_degrees * axis.z, kDegrees * c.deviation(kTurn + 2), 4) +
           "</tbody></table>\n<p class=\"note\">x points to the right, y down, z away from the camera. T x is below 0, "
           "as the right camera stands to the right. Depth suffers most from the turn about y: towards or away from "
           "the other camera.</p>\n";
}

} // namespace

std::string verdict_section(const CalibrationRun& run)
{
    const calibration::Quality& q = run.quality;
    const char* verdict = calibration::name_of(q.verdict);
    std::string html = "<p class=\"over\">Calibration of a stereo rig";
    if (run.rig.calibrated_at[0] != '\0')
        html += fill(" · {}", {escaped(run.rig.calibrated_at)});
    if (run.rig.id[0] != '\0')
        html += fill(" · {}", {escaped(run.rig.id)});
    html += fill("</p>\n<div class=\"verdict {}\"><h1>{}</h1><p>{}</p></div>\n",
                 {verdict, headline(q.verdict),
                  is_solved(run) ? meaning(q.verdict) : "No calibration came out of these pictures."});
    html += "<div class=\"next\"><h2>What to do next</h2>\n";
    if (q.verdict == Verdict::kGood && q.advice.empty()) {
        html += "<ul><li>Use the rig file. Fix both cameras and their focus; calibrate again when one was moved.</li>"
                "<li>Keep these pictures with your data, and check an object of known size now and then.</li></ul>";
    } else if (q.advice.empty()) {
        html += "<p>The reasons stand beside the pairs below.</p>";
    } else {
        html += "<ol>";
        for (const std::string& advice : q.advice)
            html += fill("<li>{}</li>", {sentence(advice)});
        html += "</ol>";
    }
    return html + "</div>\n";
}

std::string millimetres_section(const CalibrationRun& run)
{
    std::string html =
        fill("<h2 id=\"millimetres\">In millimetres</h2>\n<p>How far off a depth is expected to be because of this "
             "calibration: one standard deviation, over the part that both cameras see. At the "
             "far end of the working range, {} mm, {} % of the distance are good and {} % usable: here ± {} "
             "mm.</p>\n<div class=\"tiles\">\n",
             {fixed(run.range.far_mm, 0), fixed(calibration::kDepthGate_percent.good, 1),
              fixed(calibration::kDepthGate_percent.usable, 1), fixed(run.quality.depth_at_far.calibration_mm, 2)});
    for (const calibration::DepthError& depth : run.quality.depth)
        html +=
            fill("<div class=\"tile\"><span>at {} mm</span><b>± {} <small>mm</small></b><span>{} % of the distance; "
                 "± {} mm with the noise of one corner</span></div>\n",
                 {fixed(depth.distance_mm, 0), fixed(depth.calibration_mm, 2),
                  fixed(100 * depth.calibration_mm / depth.distance_mm, 2), fixed(depth.corner_mm, 2)});
    return html + "</div>\n";
}

std::string numbers_section(const CalibrationRun& run)
{
    const calibration::Quality& q = run.quality;
    const calibration::StereoCalibration& c = run.calibration;
    std::string html = "<table class=\"facts\"><tbody>\n";
    html +=
        row("Held-out shape", fixed(q.held_out_mm, 2) + " mm",
            fill("Boards of {} pairs, each measured by a solution that had not seen it: distance of the corners from "
                 "their true places on the board (RMS).",
                 {q.held_out_pairs}));
    html += row("Held-out depth", fixed(q.held_out_depth_mm, 2) + " mm",
                fill("The same boards come out this much too near or too far, by their size, which is {} % off "
                     "(RMS). {}",
                     {fixed(q.held_out_size_percent, 2), up_to(calibration::kDepthGate_percent, "%")}));
    html += row("Epipolar RMS", fixed(q.epipolar_rms_px, 3) + " px",
                fill("By how much the two pictures miss each other's rows; the matcher looks along one row only. {}",
                     {up_to(calibration::kEpipolarGate_px, "px")}));
    html += row("Epipolar 95 %", fixed(q.epipolar_p95_px, 3) + " px", "95 of 100 corners are better than this.");
    html += row("RMS", fixed(c.rms_px, 3) + " px",
                fill("Between where corners were seen and where the solution expects them; left {}, right {}.",
                     {fixed(c.rms_left_px, 3), fixed(c.rms_right_px, 3)}));
    html += row("Corner noise", fixed(c.sigma_px, 3) + " px",
                "Standard deviation of one coordinate of a corner, estimated from the same.");
    html += row("Baseline", with_deviation(c.rig.baseline_mm(), baseline_deviation_mm(c), 3) + " mm",
                "Distance between the two cameras. Depth is in proportion to it.");
    html += row("Focal lengths",
                fill("{} and {} px", {with_deviation(c.rig.left.fx, c.deviation(0), 1),
                                      with_deviation(c.rig.right.fx, c.deviation(9), 1)}),
                "fx of the left and of the right lens; larger sees less, but in more detail.");
    html += row("Pairs", fill("{} of {}", {c.pairs_used, run.pairs.size()}),
                fill("Used, of those that were given. Good from {}, usable from {}.",
                     {calibration::kPairsGate.good, calibration::kPairsGate.usable}));
    html += row("Pictures", fill("{} x {} px", {run.task.width, run.task.height}),
                "The calibration holds for pictures of this size and shape alone.");
    std::string boards;
    for (const calibration::Board& board : run.task.boards)
        boards +=
            fill("{}{} x {}, {} mm", {boards.empty() ? "" : "; ", board.cols, board.rows, fixed(board.square_mm, 2)});
    html += row("Board", boards, "Inner corners, and the side of a square as it was given.");
    html += row("Corners", fill("{} to {} mm", {fixed(q.nearest_mm, 0), fixed(q.farthest_mm, 0)}),
                "Distances that were seen. Nearer and farther, the errors above are guesses.");
    if (run.rig.calibrated_at[0] != '\0')
        html += row("Date", escaped(run.rig.calibrated_at), "As written into the rig file.");
    if (run.rig.id[0] != '\0')
        html += row("Calibration", fill("<code>{}</code>", {escaped(run.rig.id)}),
                    "Every cloud made with it carries this name.");
    return html + "</tbody></table>\n<div class=\"two\">\n<div>" + lens_table(run) + "</div>\n<div>" + rig_table(run) +
           "</div>\n</div>\n";
}

} // namespace dicot::app
