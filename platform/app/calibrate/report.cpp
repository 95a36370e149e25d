#include "report.h"

#include "../output_folder.h"
#include "report_page.h"
#include "report_style.h"
#include "report_svg.h"
#include "report_text.h"

#include "dicot/os/output_file.h"

#include <cerrno>
#include <cstring>
#include <unistd.h>

namespace dicot::app {
namespace {

/// The page of an earlier report would show the pictures of this one.
Status remove_page(const std::string& path)
{
    if (::unlink(path.c_str()) != 0 && errno != ENOENT)
        return failure(Fault::kCannotCreate, "%s: cannot be replaced (%s): name another folder", path.c_str(),
                       std::strerror(errno));
    return {};
}

/// What only a calibration can show; writes the rectified pair.
Result<std::string> solved_sections(const CalibrationRun& run, const std::string& folder)
{
    const Result<Rectification> flat = rectify(run.calibration.rig, kCrop, "the calibration");
    const std::optional<std::size_t> shown = middle_pair(run);
    PairPictures pictures;
    if (flat.ok() && shown)
        pictures = TRY(write_rectified(run, run.pairs[*shown], folder));
    return millimetres_section(run) + numbers_section(run) + coverage_section(run) + residual_section(run) +
           rectified_section(run, flat, shown, pictures);
}

} // namespace

Status write_report(const CalibrationRun& run, const std::string& folder)
{
    TRY(make_folder(folder));
    const std::string page = folder + "/index.html";
    TRY(remove_page(page));
    std::vector<PairPictures> pictures;
    for (std::size_t p = 0; p < run.pairs.size(); ++p)
        pictures.push_back(TRY(write_thumbnails(run.pairs[p], p + 1, folder)));
    const std::string solved = is_solved(run) ? TRY(solved_sections(run, folder)) : "";
    const std::string html =
        fill("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>"
             "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>"
             "<title>Calibration: {}</title>\n<style>{}</style></head>\n<body>\n{}{}{}{}{}"
             "</body></html>\n",
             {calibration::name_of(run.quality.verdict), kReportStyle, shared_drawings(), verdict_section(run), solved,
              pairs_section(run, pictures), is_solved(run) ? limits_section(run) : ""});
    OutputFile file;
    TRY(file.open(page.c_str()));
    TRY(file.write(html.data(), html.size()));
    return file.commit();
}

} // namespace dicot::app
