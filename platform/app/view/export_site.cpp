#include "export_site.h"

#include "../output_folder.h"
#include "../progress.h"
#include "../stop_request.h"
#include "view_site.h"

#include "dicot/os/output_file.h"

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace dicot::app {
namespace {

std::string base64(std::string_view bytes)
{
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::string_view part = bytes.substr(i, 3);
        std::uint32_t bits = 0;
        for (std::size_t j = 0; j < 3; ++j)
            bits = bits << 8 | (j < part.size() ? static_cast<unsigned char>(part[j]) : 0U);
        for (std::size_t j = 0; j < 4; ++j)
            text += j <= part.size() ? kDigits[bits >> (18 - 6 * j) & 63] : '=';
    }
    return text;
}

Status write_file(const std::string& path, std::string_view text)
{
    OutputFile file;
    TRY(file.open(path.c_str()));
    TRY(file.write(text.data(), text.size()));
    return file.commit();
}

/// Folders on the way to a file below `folder`.
Status make_folders(const std::string& folder, const std::string& path)
{
    for (std::size_t at = path.find('/'); at != std::string::npos; at = path.find('/', at + 1))
        TRY(make_folder(folder + "/" + path.substr(0, at)));
    return {};
}

bool is_picture(std::string_view path)
{
    return path.ends_with(".jpg") || path.ends_with(".png");
}

Status write_answer(const std::string& folder, const std::string& path, const Answer& answer)
{
    const bool picture = is_picture(path);
    if (picture && answer.status != 200)
        return {}; // the page says that it is not there
    TRY(make_folders(folder, path));
    if (picture)
        return write_file(folder + "/" + path, *answer.body);
    const std::string word = answer.status == 200 ? "dicotData" : "dicotFault";
    return write_file(folder + "/" + path + ".js", word + "(\"" + path + "\", \"" + base64(*answer.body) + "\");\n");
}

} // namespace

Status export_site(ViewSite& site, const std::string& folder)
{
    TRY(make_folder(folder));
    site.wait_for_growth();
    const std::vector<std::string> paths = site.paths();
    Progress bar("exporting");
    for (std::size_t i = 0; i < paths.size(); ++i) {
        if (StopRequest::asked())
            return failure(Fault::kTryAgain, "%s: stopped half-way: start the export again", folder.c_str());
        TRY(write_answer(folder, paths[i], site.answer(paths[i])));
        bar.done(static_cast<int>(i), static_cast<int>(paths.size()));
    }
    std::string page{view_page()};
    constexpr std::string_view kServer = "data-source=\"server\"", kFiles = "data-source=\"files\"";
    page.replace(page.find(kServer), kServer.size(), kFiles);
    constexpr std::string_view kHead = "<meta charset=\"utf-8\">\n"; // a policy holds for what comes behind it
    page.insert(page.find(kHead) + kHead.size(),
                "<meta http-equiv=\"Content-Security-Policy\" content=\"" + std::string{files_policy()} + "\">\n");
    return write_file(folder + "/index.html", page);
}

} // namespace dicot::app
