// dicot view: what its server answers, to whom, and what it leaves in an exported folder.
#include "archive_folder.h"
#include "drawn_plant.h"
#include "store_commands.h"

#include "stop_request.h"
#include "traits/usual_wishes.h"
#include "view/view_site.h"
#include "view/web_server.h"

#include <gmock/gmock.h>

#include <arpa/inet.h>
#include <csignal>
#include <future>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

namespace dicot {
namespace {

namespace fs = std::filesystem;
using app::Answer;
using app::ViewSite;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// What a server of this port says to these bytes, all of it.
std::string said_to(int port, const std::string& request)
{
    const int client = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    std::string said;
    if (::connect(client, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
        ::send(client, request.data(), request.size(), MSG_NOSIGNAL) == std::ssize(request)) {
        char part[4096];
        for (ssize_t got = 0; (got = ::recv(client, part, sizeof part, 0)) > 0;)
            said.append(part, static_cast<std::size_t>(got));
    }
    ::close(client);
    return said;
}

std::string request(const std::string& line, const std::string& host = "127.0.0.1")
{
    return line + " HTTP/1.1\r\nHost: " + host + "\r\nConnection: close\r\n\r\n";
}

/// The viewer upon a copy of the store, with its server in a thread.
class ViewServer : public test::StoreOfOneBoard
{
protected:
    void SetUp() override
    {
        root_ = copy();
        ASSERT_EQ(::setenv("XDG_CACHE_HOME", (root_ + "-cache").c_str(), 1), 0); // what is measured is kept there
        Result<std::unique_ptr<ViewSite>> opened = ViewSite::open(root_, wishes());
        ASSERT_TRUE(opened.ok()) << opened.status().message();
        site_ = std::move(opened).value();
        std::promise<int> told;
        server_ =
            std::thread([this, &told] { ended_ = app::serve(*site_, 0, [&told](int port) { told.set_value(port); }); });
        port_ = told.get_future().get();
    }
    void TearDown() override
    {
        if (!server_.joinable())
            return;
        (void)::raise(SIGTERM);
        server_.join();
        EXPECT_TRUE(ended_.ok()) << ended_.message();
    }
    static app::TraitsWishes wishes()
    {
        const Result<app::TraitsWishes> usual = app::usual_wishes("");
        EXPECT_TRUE(usual.ok()) << usual.status().message();
        return usual.value();
    }
    std::string get(const std::string& path) const { return said_to(port_, request("GET " + path)); }

    app::StopRequest stop_;
    std::string root_;
    std::unique_ptr<ViewSite> site_;
    std::thread server_;
    Status ended_;
    int port_ = 0;
};

TEST_F(ViewServer, ThePageAndItsDataAreGivenWithAPolicyThatAllowsNothingElse)
{
    const std::string page = get("/");
    EXPECT_THAT(page, AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("<title>dicot view</title>"),
                            HasSubstr("default-src 'none'"), HasSubstr("X-Content-Type-Options: nosniff"),
                            HasSubstr("Cross-Origin-Resource-Policy: same-origin"),
                            Not(HasSubstr("Access-Control-Allow-Origin"))));
    EXPECT_THAT(get("/data/0/1/thumb.jpg"), AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("image/jpeg")));
    const fs::path cloud = snapshots(root_).front() / "cloud.drc";
    EXPECT_THAT(get("/data/0/1/cloud.drc"), testing::EndsWith("\r\n\r\n" + test::text_of(cloud)));
}

TEST_F(ViewServer, AnotherHostIsRefused)
{
    for (const char* host : {"evil.example", "127.0.0.1.evil.example", "localhost.evil.example:80", "", "192.168.0.1"})
        EXPECT_THAT(said_to(port_, request("GET /data/archive.json", host)), StartsWith("HTTP/1.1 421")) << host;
    EXPECT_THAT(said_to(port_, "GET / HTTP/1.0\r\n\r\n"), StartsWith("HTTP/1.1 421"));
    for (const std::string host : {"127.0.0.1", "localhost"}) {
        EXPECT_THAT(said_to(port_, request("GET /data/archive.json", host)), StartsWith("HTTP/1.1 200"));
        EXPECT_THAT(said_to(port_, request("GET /data/archive.json", host + ":8080")), StartsWith("HTTP/1.1 200"));
    }
}

TEST_F(ViewServer, NothingCanBeChanged)
{
    for (const char* method : {"POST", "PUT", "DELETE", "PATCH", "OPTIONS"})
        EXPECT_THAT(said_to(port_, request(std::string(method) + " /data/0/1/cloud.drc")), StartsWith("HTTP/1.1 405"))
            << method;
    const std::string head = said_to(port_, request("HEAD /"));
    EXPECT_THAT(head, AllOf(StartsWith("HTTP/1.1 200"), Not(HasSubstr("<title>"))));
}

TEST_F(ViewServer, NoPathLeadsElsewhere)
{
    std::ofstream(root_ + "/secret") << "secret";
    const fs::path left = snapshots(root_).front() / "left.jpg";
    for (const char* path :
         {"/../secret", "/data/../secret", "/data/0/../../secret", "/%2e%2e/secret", "/data/0/1/../../../secret",
          "/data/0/1/%2e%2e%2f%2e%2e%2fsecret", "/data/0/1/record.json", "/data/0/1/SHA256SUMS", "//secret",
          "/data/0/01/cloud.drc", "/data/+0/1/cloud.drc", "/data/0/1/cloud.drc/", "/data/-1/slots.json",
          "/data/1/slots.json", "/data/0/99/snapshot.json", "/data/0/1/cloud.drc%00.jpg", "/secret"})
        EXPECT_THAT(get(path), AllOf(StartsWith("HTTP/1.1 404"), Not(HasSubstr("secret\n")))) << path;
    EXPECT_THAT(said_to(port_, request("GET http://127.0.0.1/etc/passwd")), Not(HasSubstr("root:")));
    // Nor does a link in the archive.
    fs::remove(left);
    fs::create_symlink(root_ + "/secret", left);
    EXPECT_THAT(get("/data/0/1/left.jpg"), Not(HasSubstr("\r\n\r\nsecret")));
}

TEST_F(ViewServer, ARangeBehindTheEndGivesNothingElse)
{
    const std::string whole = *site_->answer("data/0/slots.json").body;
    ASSERT_LT(whole.size(), 500U);
    for (const std::string range : {"0-9999", "500-9999", "99999999999-99999999999"}) {
        const std::string said = said_to(port_, "GET /data/0/slots.json HTTP/1.1\r\nHost: localhost\r\n"
                                                "Connection: close\r\nRange: bytes=" +
                                                    range + "\r\n\r\n");
        const std::size_t head = said.find("\r\n\r\n");
        ASSERT_NE(head, std::string::npos) << range;
        EXPECT_LE(said.size() - head, 4 + whole.size()) << range;
    }
}

TEST_F(ViewServer, WhatIsNoRequestIsSurvived)
{
    for (const std::string& bytes :
         {std::string("\r\n\r\n"), std::string(20'000, 'A'), std::string("GET \xff\xfe HTTP/1.1\r\n\r\n"),
          "GET /" + std::string(9'000, 'a') + " HTTP/1.1\r\nHost: localhost\r\n\r\n"})
        (void)said_to(port_, bytes);
    EXPECT_THAT(get("/data/archive.json"), StartsWith("HTTP/1.1 200"));
}

TEST_F(ViewServer, ASecondOneDoesNotShareThePort)
{
    const Status second = app::serve(*site_, port_, [](int) {});
    EXPECT_EQ(second.fault(), Fault::kUnavailable);
    EXPECT_THAT(second.message(), HasSubstr("--port"));
}

TEST_F(ViewServer, ItEndsAtOnceWhenAsked)
{
    const auto start = std::chrono::steady_clock::now();
    (void)::raise(SIGINT);
    server_.join();
    EXPECT_TRUE(ended_.ok());
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST_F(ViewServer, EverySlotIsToldAndWhatComesLaterToo)
{
    const auto told = [this](const char* path) { return json::parse(*site_->answer(path).body); };
    EXPECT_EQ(told("data/archive.json")["boards"], (json{{{"name", "bench"}, {"slots", 3}}}));
    const json slots = told("data/0/slots.json");
    EXPECT_EQ(slots["sequence"], (json{1, 2, 3}));
    EXPECT_EQ(slots["state"], "dmd");
    EXPECT_EQ(slots["reason"], (json{-1, 0, -1}));
    EXPECT_THAT(slots["reasons"][0].get<std::string>(), HasSubstr("is gone"));
    const json snapshot = told("data/0/1/snapshot.json");
    EXPECT_EQ(snapshot["record"]["device"], "bench");
    EXPECT_EQ(snapshot["files"]["cloud.drc"], "ok");
    ASSERT_EQ(snap(root_).exit_code, 0);
    EXPECT_EQ(told("data/archive.json")["boards"][0]["slots"], 4);
    EXPECT_EQ(told("data/0/slots.json")["state"], "dmdd");
}

TEST_F(ViewServer, DamageIsNamed)
{
    const fs::path cloud = snapshots(root_).back() / "cloud.drc";
    fs::resize_file(cloud, fs::file_size(cloud) / 2);
    const json snapshot = json::parse(*site_->answer("data/0/3/snapshot.json").body);
    EXPECT_THAT(snapshot["files"]["cloud.drc"].get<std::string>(), HasSubstr("cloud.drc"));
    const Answer plants = site_->answer("data/0/3/plants.json");
    EXPECT_EQ(plants.status, 500);
    EXPECT_THAT(*plants.body, HasSubstr("cloud.drc"));
    EXPECT_EQ(site_->answer("data/0/1/cloud.drc").status, 200);
}

TEST_F(ViewServer, ACloudAloneIsABoardOfOneSlot)
{
    const fs::path cloud = snapshots(root_).front() / "cloud.drc";
    Result<std::unique_ptr<ViewSite>> alone = ViewSite::open(cloud.string(), wishes());
    ASSERT_TRUE(alone.ok());
    const json slots = json::parse(*alone.value()->answer("data/0/slots.json").body);
    EXPECT_EQ(slots["sequence"], json{1});
    EXPECT_EQ(*alone.value()->answer("data/0/1/cloud.drc").body, test::text_of(cloud));
    EXPECT_EQ(alone.value()->answer("data/0/1/left.jpg").status, 200); // made of the cloud
    EXPECT_FALSE(ViewSite::open(root_ + "/nothing", wishes()).ok());
}

TEST_F(ViewServer, GrowthIsOfEverySlot)
{
    site_->wait_for_growth();
    const json curves = json::parse(*site_->answer("data/0/curves.json").body);
    EXPECT_EQ(curves["complete"], true) << curves;
    EXPECT_EQ(curves["slots"], 3);
    EXPECT_FALSE(curves.contains("error")) << curves["error"];
    EXPECT_EQ(curves["traits"][0]["key"], "leaf_area_visible_mm2");
    ASSERT_EQ(curves["gaps"].size(), 1U) << curves["gaps"];
    EXPECT_EQ(curves["gaps"][0]["slots"], 1);
    EXPECT_THAT(curves["gaps"][0]["reason"].get<std::string>(), HasSubstr("is gone"));
}

TEST_F(ViewServer, PlantsBearTheNamesOfTheirPlaces)
{
    const std::string archive = root_ + "-beds", table = root_ + "-beds.csv";
    test::write_plant(root_ + ".drc", {.leaves = 4});
    test::ArchiveFolder(archive, "bench").done(1, "2026-06-01T12:00:00Z", root_ + ".drc");
    std::ofstream(table) << "name,min_x_mm,min_y_mm,min_z_mm,max_x_mm,max_y_mm,max_z_mm\n"
                            "\"<i>basil, red\",,,,,,\nempty,-9000,-9000,,-8000,-8000,\n";
    const Result<app::TraitsWishes> named = app::usual_wishes(table);
    ASSERT_TRUE(named.ok()) << named.status().message();
    const auto site = ViewSite::open(archive, named.value());
    ASSERT_TRUE(site.ok()) << site.status().message();
    site.value()->wait_for_growth();
    const json plants = json::parse(*site.value()->answer("data/0/1/plants.json").body).at("plants");
    const json curves = json::parse(*site.value()->answer("data/0/curves.json").body).at("plants");
    ASSERT_EQ(plants.size(), 2U);
    ASSERT_EQ(curves.size(), 2U);
    for (const json& told : {plants, curves}) {
        EXPECT_EQ(told[0]["name"], "<i>basil, red");
        EXPECT_EQ(told[1]["name"], "empty");
    }
    EXPECT_NEAR(plants[0]["leaf_count"]["value"].get<double>(), 4, 0.1);
    EXPECT_EQ(plants[1]["points"], 0);
    EXPECT_EQ(curves[0]["series"]["leaf_count"]["value"].size(), 1U);
    EXPECT_TRUE(curves[1]["series"].empty()) << curves[1];
}

TEST_F(ViewServer, APlantsTableThatIsMissingOrWrongIsRefusedBeforeAnythingIsServed)
{
    const std::string view = "view '" + root_ + "' --no-open --plants '" + root_;
    EXPECT_EQ(dicot(view + "/nowhere.csv'").exit_code, 66);
    std::ofstream(root_ + "/table.csv") << "name,min_x_mm\nbasil,5\n";
    const test::ToolRun run = dicot(view + "/table.csv'");
    EXPECT_EQ(run.exit_code, 65);
    EXPECT_THAT(run.output, HasSubstr("table.csv: it has no column min_y_mm"));
}

TEST_F(ViewServer, ABoardsProgramSaysThatItHasNoViewer)
{
    const test::ToolRun run = test::run(DICOT_BOARD " view '" + root_ + "'");
    EXPECT_EQ(run.exit_code, 69);
    EXPECT_THAT(run.output, HasSubstr("built without the viewer"));
    EXPECT_EQ(test::run("ldd " DICOT_BOARD).output.find("libssl"), std::string::npos);
}

TEST_F(ViewServer, AnExportHasAFileForEachAnswer)
{
    const std::string into = root_ + "-export";
    const test::ToolRun run = dicot("view '" + root_ + "' --export '" + into + "'");
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(test::text_of(into + "/index.html").substr(0, 400),
                AllOf(HasSubstr("data-source=\"files\""),
                      HasSubstr("<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'")));
    for (const std::string& path : site_->paths()) {
        const bool picture = path.ends_with(".jpg") || path.ends_with(".png");
        EXPECT_TRUE(fs::exists(into + "/" + path + (picture ? "" : ".js"))) << path;
    }
    // base64 as coreutils has it
    const std::string script = test::text_of(into + "/data/0/1/cloud.drc.js");
    const std::string cloud = (snapshots(root_).front() / "cloud.drc").string();
    const std::string base64 = test::run("base64 -w0 '" + cloud + "'").output;
    EXPECT_EQ(script, "dicotData(\"data/0/1/cloud.drc\", \"" + base64 + "\");\n");
    EXPECT_FALSE(fs::exists(into + "/data/0/2/cloud.drc.js"));
}

} // namespace
} // namespace dicot
