// A store in a folder of its own, and what tests do with it.
#pragma once

#include "temp_folder.h"

#include "dicot/medium/disk_medium.h"
#include "dicot/store/store.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dicot::test {

inline constexpr std::int64_t kSecond = 1'000'000;
inline constexpr std::int64_t kNoon = 1'780'315'200 * kSecond; ///< 2026-06-01T12:00:00Z

inline std::string record_words(std::int64_t sequence, const std::string& time, bool done, const std::string& reason)
{
    return R"({"format": "dicot record 1", "sequence": )" + std::to_string(sequence) + R"(, "time": ")" + time +
           R"(", "outcome": ")" + (done ? "done" : "missed") + R"(", "reason": )" +
           (done ? "null" : "\"" + reason + "\"") + R"(, "clock": {"trust": "set"}, "cloud": {"points": )" +
           std::to_string(done ? sequence * 10 : 0) + "}}\n";
}

inline std::string time_of_folder(const std::string& folder)
{
    const std::string stamp = folder.substr(folder.size() - 16);
    return stamp.substr(0, 4) + "-" + stamp.substr(4, 2) + "-" + stamp.substr(6, 5) + ":" + stamp.substr(11, 2) + ":" +
           stamp.substr(13, 3);
}

inline Status add_text(Store& store, const char* name, std::string_view text)
{
    return store.add(name, [&](ByteSink& sink) { return sink.write(std::as_bytes(std::span(text))); });
}

/// One whole snapshot.
inline Status store_one(Store& store, std::int64_t began_us, std::string_view cloud = "the points")
{
    TRY(store.begin({began_us, {}}));
    TRY(add_text(store, "cloud.drc", cloud));
    TRY(add_text(store, "left.jpg", "the picture"));
    TRY(add_text(store, "record.json", record_words(store.sequence(), time_of_folder(store.folder()), true, "")));
    return store.commit({true, "", "set", store.sequence() * 10});
}

inline Status miss_one(Store& store, std::int64_t began_us, const std::string& reason)
{
    TRY(store.begin({began_us, {}}));
    TRY(add_text(store, "record.json", record_words(store.sequence(), time_of_folder(store.folder()), false, reason)));
    return store.commit({false, reason.c_str(), "set", 0});
}

inline std::vector<SlotRow> rows_of(Catalogue& catalogue, const SlotQuery& query = {})
{
    std::vector<SlotRow> rows;
    const Status status = catalogue.for_each(query, [&](const SlotRow& row) { return rows.push_back(row), true; });
    EXPECT_TRUE(status.ok()) << status.message();
    return rows;
}

class StoreScene : public ::testing::Test
{
protected:
    std::string root() const { return folder_.path("."); }
    std::string at(const std::string& path) const { return folder_.path(path); }
    std::string catalogue_path() const { return at(Store::kCatalogueName); }

    /// A store of its own medium; what was opened before is let go first.
    Store& open(const StoreRules& rules = {.reserve_bytes = 0, .prune = Prune::kPulled})
    {
        store_.reset();
        medium_ = open_disk_medium(root()).value();
        auto opened = Store::open(*medium_, rules, catalogue_path());
        EXPECT_TRUE(opened.ok()) << opened.status().message();
        store_ = std::move(opened).value();
        return *store_;
    }
    void close() { store_.reset(); }
    Medium& medium() { return *medium_; }

    std::vector<Finding::Kind> kinds;
    std::vector<std::string> places;    ///< of what verify found
    std::vector<std::string> sentences; ///< as long
    VerifyReport verify(bool repair = false)
    {
        kinds.clear();
        places.clear();
        sentences.clear();
        const auto report = store_->verify(
            repair,
            [&](const Finding& finding) {
                kinds.push_back(finding.kind);
                places.emplace_back(finding.path);
                sentences.emplace_back(finding.sentence);
            },
            [](int, int) {});
        EXPECT_TRUE(report.ok()) << report.status().message();
        return report.ok() ? report.value() : VerifyReport{};
    }

    std::string text_at(const std::string& path) const
    {
        std::ifstream file(at(path), std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    void write_at(const std::string& path, const std::string& text) const
    {
        std::ofstream(at(path), std::ios::binary) << text;
    }
    bool is_at(const std::string& path) const { return std::filesystem::exists(at(path)); }

private:
    TempFolder folder_;
    std::unique_ptr<Medium> medium_;
    std::unique_ptr<Store> store_;
};

} // namespace dicot::test
