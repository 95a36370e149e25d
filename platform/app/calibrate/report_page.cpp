#include "report_page.h"

#include "report_svg.h"
#include "report_text.h"

#include <cmath>

namespace dicot::app {
namespace {

std::string heading(const char* id, const char* title)
{
    return fill("<h2 id=\"{}\">{}</h2>\n", {id, title});
}

std::string figure(const char* kind, const std::string& drawing, const std::string& caption)
{
    return fill("<figure class=\"{}\">\n{}<figcaption>{}</figcaption></figure>\n", {kind, drawing, caption});
}

std::string listed(const std::vector<std::string>& words)
{
    std::string all;
    for (std::size_t k = 0; k < words.size(); ++k)
        all += (k == 0 ? "" : k + 1 == words.size() ? " and " : ", ") + words[k];
    return all;
}

const char* title_of(Eye eye)
{
    return eye == Eye::kLeft ? "Left" : "Right";
}

std::string key(Eye eye)
{
    return fill("<i class=\"key {}\"></i>", {name_of(eye)});
}

double rms_of(const CalibrationRun& run, Eye eye)
{
    return eye == Eye::kLeft ? run.calibration.rms_left_px : run.calibration.rms_right_px;
}

} // namespace

std::string coverage_section(const CalibrationRun& run)
{
    std::string html =
        heading("coverage", "Coverage") +
        "<p>A lens is known where corners were seen. Dots are the corners of the used pairs; the greener "
        "a cell, the more of them; hatched cells have none.</p>\n<div class=\"two\">\n";
    for (const Eye eye : kEyes) {
        const calibration::Coverage& coverage = eye == Eye::kLeft ? run.quality.left : run.quality.right;
        const std::vector<std::string> empty = empty_parts(coverage);
        html += figure(name_of(eye), coverage_chart(run, eye, corner_misses(run, eye)),
                       fill("<b>{} camera.</b> Corners in {} % of the cells. {}",
                            {title_of(eye), fixed(100 * coverage.share, 0),
                             empty.empty() ? "No part is left out." : fill("Mostly empty: {}.", {listed(empty)})}));
    }
    html += "</div>\n<h3>Distance</h3>\n";
    const auto& boards = run.quality.boards_by_distance;
    constexpr std::array<const char*, calibration::kDistanceBins> kThirds{"near", "middle", "far"};
    std::vector<std::string> empty;
    int inside = 0;
    for (std::size_t bin = 0; bin < boards.size(); ++bin) {
        inside += boards[bin];
        if (boards[bin] == 0)
            empty.emplace_back(kThirds[bin]);
    }
    int all = 0;
    for (const calibration::ViewOutcome& view : run.calibration.views)
        all += view.used ? 1 : 0;
    html += figure("", distance_chart(run),
                   fill("Boards of the used pairs in the working range of {} to {} mm; each tick is a board. Corners "
                        "lay between {} "
                        "and {} mm from the left camera.{}{}",
                        {fixed(run.range.near_mm, 0), fixed(run.range.far_mm, 0), fixed(run.quality.nearest_mm, 0),
                         fixed(run.quality.farthest_mm, 0),
                         inside == all ? "" : fill(" Outside of the range: {} of {} boards.", {all - inside, all}),
                         empty.empty() ? "" : fill(" <b>Empty: {} third.</b>", {listed(empty)})}));
    return html;
}

std::string residual_section(const CalibrationRun& run)
{
    std::string html = heading("residuals", "Residuals") +
                       "<p>What is left between where a corner was seen and where the solution expects it. Good "
                       "calibrations leave round clouds around zero and arrows without a common direction.</p>\n"
                       "<div class=\"two\">\n";
    const std::array<std::vector<CornerMiss>, 2> misses{corner_misses(run, Eye::kLeft),
                                                        corner_misses(run, Eye::kRight)};
    const double reach =
        std::max(scatter_reach(misses[0], rms_of(run, Eye::kLeft)), scatter_reach(misses[1], rms_of(run, Eye::kRight)));
    for (const Eye eye : kEyes) {
        const std::vector<CornerMiss>& own = misses[eye == Eye::kLeft ? 0 : 1];
        html += figure(eye == Eye::kLeft ? "small left" : "small right", scatter_chart(own, rms_of(run, eye), reach),
                       fill("<b>{} camera.</b> {} corners; dashed: the RMS of {} px.",
                            {title_of(eye), own.size(), fixed(rms_of(run, eye), 3)}));
    }
    const double factor = arrow_factor(run.calibration.rms_px, run.task.width);
    for (const Eye eye : kEyes)
        html += figure(
            name_of(eye), arrow_chart(misses[eye == Eye::kLeft ? 0 : 1], run.task.width, run.task.height, factor),
            fill("<b>{} camera.</b> From the expected place towards where the corner was seen, drawn {} times "
                 "as long as it is.",
                 {title_of(eye), fixed(factor, factor < 1 ? 1 : 0)}));
    return html + "</div>\n<h3>By pair</h3>\n" +
           figure(
               "", pair_bars(run),
               fill("RMS in px of each pair, by its number below: {}left, {}right; dashed bars were dropped, – was not "
                    "given to the solver. The dashed line is the RMS of all, {} px.",
                    {key(Eye::kLeft), key(Eye::kRight), fixed(run.calibration.rms_px, 3)}));
}

std::string rectified_section(const CalibrationRun& run, const Result<Rectification>& flat,
                              std::optional<std::size_t> shown, const PairPictures& pictures)
{
    std::string html = heading("rectified", "Rectified pair");
    if (!flat.ok())
        return html + fill("<p>The pair cannot be rectified: {}</p>\n", {escaped(flat.status().message())});
    const RowGaps all = row_gaps(run, flat.value());
    html +=
        fill("<p>After rectification a point lies on the same row of both pictures. <b>Rows agree within {} px</b> for "
             "95 of 100 corners of all used pairs; RMS {} px, the worst {} px.</p>\n",
             {fixed(all.p95_px, 2), fixed(all.rms_px, 3), fixed(all.most_px, 2)});
    RowGaps own;
    if (shown) {
        const SeenPair& pair = run.pairs[*shown];
        own.add(run.calibration.rig, flat.value(), pair.left.corners, pair.right.corners);
        own.sum_up();
        if (!pictures.left.file.empty() && !pictures.right.file.empty())
            html +=
                figure("", rectified_drawing(run, flat.value(), pair, pictures),
                       fill("<a href=\"#pair-{}\">Pair {}</a>, both pictures as the matcher sees them. Follow a line "
                            "from left to right: it crosses the same things. Crosses are the corners.",
                            {*shown + 1, *shown + 1}));
    }
    for (const ReportPicture* picture : {&pictures.left, &pictures.right})
        if (!picture->missing.empty())
            html += fill("<p class=\"note\">No picture here: {}</p>\n", {escaped(picture->missing)});
    const auto line = [&](const char* what, double every, double one) {
        return fill("<tr><th scope=\"row\">{}</th><td class=\"plain\">{} px</td><td class=\"plain\">{}</td></tr>\n",
                    {what, fixed(every, 3), own.gaps_px.empty() ? "" : fixed(one, 3) + " px"});
    };
    return html + "<div class=\"two\">\n" +
           figure("", gap_histogram(all),
                  fill("Row in the left minus row in the right rectified picture, {} corners. The outermost bars hold "
                       "what lies beyond.",
                       {all.gaps_px.size()})) +
           "<div><table><thead><tr><th>rows differ by</th><th>all used pairs</th><th>" +
           (shown ? fill("pair {}", {*shown + 1}) : "") + "</th></tr></thead><tbody>\n" +
           line("RMS", all.rms_px, own.rms_px) + line("95 of 100 below", all.p95_px, own.p95_px) +
           line("worst corner", all.most_px, own.most_px) + "</tbody></table></div>\n</div>\n";
}

std::string pairs_section(const CalibrationRun& run, const std::vector<PairPictures>& pictures)
{
    std::vector<std::string> out;
    for (std::size_t p = 0; p < run.pairs.size(); ++p)
        if (!is_used(run, run.pairs[p]))
            out.push_back(fill("<a href=\"#pair-{}\">{}</a>", {p + 1, p + 1}));
    std::string html = heading("pairs", "Pairs") + fill("<p>{} of {} pairs were used{}. Corners are coloured and "
                                                        "joined row by row; the filled dot is the first. It "
                                                        "must be the same corner on both sides.</p>\n",
                                                        {run.calibration.pairs_used, run.pairs.size(),
                                                         out.empty() ? "" : ", not used: " + listed(out)});
    for (std::size_t p = 0; p < run.pairs.size(); ++p) {
        const SeenPair& pair = run.pairs[p];
        const auto* outcome = outcome_of(run, pair);
        const bool used = is_used(run, pair);
        html += fill("<section class=\"pair{}\" id=\"pair-{}\">\n<div><h3>{}</h3><p class=\"files\">{}</p>",
                     {used ? "" : " out", p + 1, p + 1, escaped(pair.name)});
        html += fill("<p class=\"state\">{}</p>", {used ? "used" : "not used"});
        if (const std::string reason = reason_of(run, pair); !reason.empty())
            html += fill("<p>{}</p>", {escaped(reason)});
        for (const Eye eye : kEyes) {
            const double px = outcome == nullptr ? 0 : eye == Eye::kLeft ? outcome->rms_left_px : outcome->rms_right_px;
            if (px > 0)
                html += fill("<p>{}{} {} px RMS</p>", {key(eye), name_of(eye), fixed(px, 3)});
        }
        if (run.task.boards.size() > 1 && pair.board >= 0) {
            const calibration::Board& board = run.task.boards[static_cast<std::size_t>(pair.board)];
            html += fill("<p class=\"files\">board {} x {}, {} mm</p>",
                         {board.cols, board.rows, fixed(board.square_mm, 1)});
        }
        html += "</div>\n";
        html += corner_drawing(pictures[p].left, fill("Pair {}, left", {p + 1}), run, pair.left, pair.board);
        html += corner_drawing(pictures[p].right, fill("Pair {}, right", {p + 1}), run, pair.right, pair.board);
        html += "</section>\n";
    }
    return html;
}

std::string limits_section(const CalibrationRun& run)
{
    const bool bow = run.task.fit_warp;
    return heading("limits", "What this page cannot see") +
           fill("<ul>\n<li>A wrong side length of the squares: a board printed 1 % too large makes everything 1 % too "
                "large. Measure it over many squares.</li>\n"
                "<li>Anything after the pictures were taken: a knock, another focus, warmth. 0.04 degrees between the "
                "cameras are 5 mm at 0.8 m, and rows stay aligned. Look at an object of known distance now and "
                "then.</li>\n"
                "<li>The errors are those of the geometry and of a chessboard's corners. A leaf is matched less well "
                "than "
                "a corner: that error comes on top.</li>\n"
                "<li>± is one standard deviation, under the assumption that each corner's noise is its own. {}</li>\n"
                "<li>The lens model is a pinhole with k1 k2 p1 p2{}: wider than about 120 degrees needs another.</li>\n"
                "</ul>\n",
                {bow ? fill("The board's bow was fitted: {} mm along its columns, {} mm along its rows; residuals take "
                            "it "
                            "into account.",
                            {fixed(run.calibration.warp_mm[0], 2), fixed(run.calibration.warp_mm[1], 2)})
                     : "The board was taken as flat; a bent one makes these deviations too small: then believe the "
                       "boards "
                       "that were held out.",
                 run.task.fit_k3 ? " k3" : ""});
}

} // namespace dicot::app
