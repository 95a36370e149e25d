#include "web_server.h"

#include "../stop_request.h"
#include "view_site.h"

#include <httplib.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <sys/socket.h>
#include <thread>

namespace dicot::app {
namespace {

constexpr const char* kHere = "127.0.0.1";
constexpr std::size_t kThreads = 4;
constexpr auto kSoon = std::chrono::milliseconds(1);
constexpr auto kLook = std::chrono::milliseconds(50);

bool is_this_computer(const std::string& host)
{
    const std::string name = host.substr(0, host.find(':'));
    return name == kHere || name == "localhost";
}

void set_headers(httplib::Response& response)
{
    response.set_header("Content-Security-Policy", std::string{server_policy()});
    response.set_header("X-Content-Type-Options", "nosniff");
    response.set_header("Cross-Origin-Resource-Policy", "same-origin");
    response.set_header("Cross-Origin-Opener-Policy", "same-origin");
    response.set_header("Referrer-Policy", "no-referrer");
    response.set_header("Cache-Control", "no-store");
}

void set_sentence(httplib::Response& response, int status, const char* sentence)
{
    response.status = status;
    response.set_content(sentence, "text/plain; charset=utf-8");
}

void respond(ViewSite& site, const httplib::Request& request, httplib::Response& response)
{
    set_headers(response);
    if (!is_this_computer(request.get_header_value("Host")))
        return set_sentence(response, 421, "This address answers to 127.0.0.1 and localhost alone.");
    if (request.method != "GET" && request.method != "HEAD") {
        response.set_header("Allow", "GET, HEAD");
        return set_sentence(response, 405, "Nothing can be changed here.");
    }
    const std::string_view path = request.path;
    const Answer answer = path.starts_with('/') ? site.answer(path.substr(1)) : site.answer("?");
    response.status = answer.status;
    // Given piece by piece, a body is not compressed, which takes seconds and saves nothing within one computer.
    if (answer.body->empty())
        return;
    response.set_content_provider(answer.body->size(), answer.type,
                                  [body = answer.body](std::size_t at, std::size_t size, httplib::DataSink& sink) {
                                      // The library hands on any Range that is asked for, even behind the end.
                                      return at < body->size() &&
                                             sink.write(body->data() + at, std::min(size, body->size() - at));
                                  });
}

} // namespace

Status serve(ViewSite& site, int port, FunctionRef<void(int port)> ready)
{
    httplib::Server server;
    server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
    server.set_socket_options([](int socket) { // the library's own would share the port with another program
        const int yes = 1;
        (void)::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    server.set_keep_alive_timeout(1); // an end waits for it
    server.set_read_timeout(2);
    server.set_pre_routing_handler([&site](const httplib::Request& request, httplib::Response& response) {
        respond(site, request, response);
        return httplib::Server::HandlerResponse::Handled;
    });
    const int bound = port == 0 ? server.bind_to_any_port(kHere) : server.bind_to_port(kHere, port) ? port : -1;
    if (bound < 0)
        return failure(Fault::kUnavailable, "port %d of %s is taken: give another one with --port, or 0 for any", port,
                       kHere);
    std::atomic<bool> ended{false};
    std::thread listener([&server, &ended] {
        (void)server.listen_after_bind();
        ended = true;
    });
    // stop() does nothing to a server that does not listen yet, and it would listen for ever.
    while (!server.is_running() && !ended)
        std::this_thread::sleep_for(kSoon);
    ready(bound);
    while (!StopRequest::asked() && !ended)
        std::this_thread::sleep_for(kLook);
    server.stop();
    listener.join();
    if (!StopRequest::asked())
        return failure(Fault::kOsError, "port %d of %s: the system took it away", bound, kHere);
    return {};
}

} // namespace dicot::app
