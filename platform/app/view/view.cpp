// dicot view: the archive as a page.
#include "../commands.h"
#include "../pull/archive_folder.h"
#include "../stop_request.h"
#include "../traits/usual_wishes.h"
#include "export_site.h"
#include "view_site.h"
#include "view_words.h"
#include "web_server.h"

#include <cstdio>
#include <cstdlib>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace dicot::app {
namespace {

/// Where there is a desktop. The program's end is not waited for: it may be the browser's.
void open_browser(std::string url)
{
    if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr)
        return;
    std::string program = "xdg-open";
    char* const words[] = {program.data(), url.data(), nullptr};
    pid_t child = 0;
    (void)::posix_spawnp(&child, program.c_str(), nullptr, nullptr, words, environ);
}

Status run(const ViewWords& words)
{
    const StopRequest stop;
    const std::string path = TRY(archive_folder(words.path));
    TraitsWishes wishes = TRY(usual_wishes(words.places));
    wishes.query.last = words.last;
    wishes.threads = 1; // the other processors are for who looks
    const std::unique_ptr<ViewSite> site = TRY(ViewSite::open(path, wishes));
    if (!words.export_folder.empty()) {
        TRY(export_site(*site, words.export_folder));
        std::printf("%s/index.html\n", words.export_folder.c_str());
        return {};
    }
    return serve(*site, words.port, [&words](int port) {
        const std::string url = "http://127.0.0.1:" + std::to_string(port) + "/";
        std::printf("%s  (Ctrl-C ends it)\n", url.c_str());
        std::fflush(stdout);
        if (!words.no_open)
            open_browser(url);
    });
}

} // namespace

void add_view(CLI::App& program, Command& chosen)
{
    add_view_words(program, chosen, run);
}

} // namespace dicot::app
