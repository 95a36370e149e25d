#include "crash_verdict.h"

#include "dicot/os/sha256.h"

#include <algorithm>
#include <set>
#include <string_view>

namespace dicot::test {
namespace {

constexpr std::int64_t kLater = 1'780'401'600'000'000; ///< 2026-06-02T12:00:00Z
constexpr unsigned kLaterSeed = 77;
constexpr std::size_t kLaterBytes = 2000;

std::string text_of(const CardBytes& bytes)
{
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string sums_of(const Files& files, const std::string& listed)
{
    // In the order in which they stand there: that is the store's own affair.
    std::string expected;
    for (std::size_t at = 0; at < listed.size();) {
        const std::size_t end = std::min(listed.find('\n', at), listed.size());
        const std::string line = listed.substr(at, end - at);
        const auto file = files.find(line.substr(std::min<std::size_t>(line.size(), 66)));
        if (file != files.end())
            expected += std::string{hex_of(sha256_of(std::as_bytes(std::span{file->second}))).data()} + "  " +
                        file->first + "\n";
        at = end + 1;
    }
    return expected;
}

class Judge
{
public:
    Judge(CrashMedium& card, const Story& story, Moment moment) : card_(card), story_(story), moment_(moment) {}

    Recovered judge();

private:
    void say(const std::string& sentence) { out_.verdict.push_back(sentence); }
    bool open();
    void read_rows();
    void look_at_each(const Told& told);
    void look_at_acknowledged(const Told& told);
    void look_at_interrupted(const Told& told);
    void look_for_strangers();
    void verify();
    void look_at_quarantine();
    bool is_idle_start() const;
    void store_another();
    bool may_be(Moment from) const { return from <= moment_; }
    bool is_there(const Told& told) const { return card_.now().find(told.folder) >= 0; }
    Files files_of(const Told& told) const;
    /// What differs; "" if nothing.
    std::string differs(const Told& told, const Content& content) const;
    const SlotRow* row_of(std::int64_t sequence) const
    {
        const auto row = rows_.find(sequence);
        return row == rows_.end() ? nullptr : &row->second;
    }

    CrashMedium& card_;
    const Story& story_;
    Moment moment_;
    Recovered out_;
    std::unique_ptr<Store> store_;
    std::map<std::int64_t, SlotRow> rows_;
};

bool Judge::open()
{
    store_.reset();
    auto opened = Store::open(card_, StoryRules{}.store, Store::kCatalogueName, CrashVfs::kName);
    if (!opened.ok()) {
        say(std::string{"the store does not open: "} + opened.status().message());
        return false;
    }
    store_ = std::move(opened).value();
    return true;
}

void Judge::read_rows()
{
    rows_.clear();
    const Status read = store_->catalogue().for_each({}, [&](const SlotRow& row) {
        if (!rows_.emplace(row.sequence, row).second)
            say("two rows of one sequence");
        return true;
    });
    if (!read.ok())
        say(std::string{"the rows cannot be read: "} + read.message());
}

Files Judge::files_of(const Told& told) const
{
    Files files;
    const CardState& state = card_.now();
    const int folder = state.find(told.folder);
    for (const auto& [name, number] : state.nodes[static_cast<std::size_t>(folder)].entries)
        files[name] = text_of(state.nodes[static_cast<std::size_t>(number)].bytes);
    return files;
}

std::string Judge::differs(const Told& told, const Content& content) const
{
    if (!is_there(told))
        return "it is not there";
    Files files = files_of(told);
    const std::string sums = files["SHA256SUMS"];
    files.erase("SHA256SUMS");
    files.erase("PULLED");
    if (files != content.files)
        return "its files are not those that were stored";
    if (sums != sums_of(content.files, sums) ||
        std::count(sums.begin(), sums.end(), '\n') != static_cast<std::ptrdiff_t>(files.size()))
        return "SHA256SUMS is wrong";
    const SlotRow* row = row_of(told.sequence);
    if (row == nullptr)
        return "it has no row";
    if (row->kept != Kept::kHere || row->done != content.done || row->reason.view() != content.reason ||
        row->points != (content.done ? told.sequence * 10 : 0))
        return "its row says something else";
    return "";
}

void Judge::look_at_acknowledged(const Told& told)
{
    const std::string which = "snapshot " + std::to_string(told.sequence) + ", acknowledged: ";
    const SlotRow* row = row_of(told.sequence);
    if (may_be(told.prune_from) && !is_there(told)) {
        if (row == nullptr || row->kept != Kept::kPruned)
            say(which + "pruned, and its row does not say so");
        return;
    }
    if (const std::string what = differs(told, told.contents.back()); !what.empty())
        say(which + what);
    else if (told.pulled <= moment_ ? row->pulled_us != told.pulled_us
                                    : row->pulled_us && !(may_be(told.pull_from) && row->pulled_us == told.pulled_us))
        say(which + "whether it was pulled is wrong");
}

void Judge::look_at_interrupted(const Told& told)
{
    const std::string which = "snapshot " + std::to_string(told.sequence) + ", interrupted: ";
    const SlotRow* row = row_of(told.sequence);
    if (!is_there(told)) {
        if (row != nullptr || told.begun <= moment_)
            say(which + (row == nullptr ? "begun, and forgotten" : "a row without a folder"));
        return;
    }
    if (may_be(told.commit_from) && std::any_of(told.contents.begin(), told.contents.end(),
                                                [&](const Content& content) { return differs(told, content).empty(); }))
        return;
    const Files files = files_of(told);
    const bool bare = files.size() == 2 && files.count("record.json") == 1 && files.count("SHA256SUMS") == 1;
    if (!bare || row == nullptr || row->done || !row->reason.view().starts_with("interrupted"))
        say(which + "neither whole nor a miss");
    else if (row->due_us != told.due_us)
        say(which + "when it was planned is forgotten");
}

void Judge::look_at_each(const Told& told)
{
    if (told.acknowledged <= moment_)
        look_at_acknowledged(told);
    else if (may_be(told.begin_from))
        look_at_interrupted(told);
    else if (row_of(told.sequence) != nullptr)
        say("snapshot " + std::to_string(told.sequence) + " has a row before it began");
}

void Judge::look_for_strangers()
{
    std::set<std::string> folders;
    for (const Told& told : story_.all)
        folders.insert(told.folder);
    const CardState& state = card_.now();
    for (const auto& [day, number] : state.nodes[CardState::kRoot].entries) {
        const CardNode& node = state.nodes[static_cast<std::size_t>(number)];
        if (!node.folder || day[0] < '0' || day[0] > '9')
            continue;
        for (const auto& [name, inside] : node.entries)
            if (std::string path = day; folders.count(path.append("/").append(name)) == 0)
                say(path + " was never stored");
    }
    for (const auto& [sequence, row] : rows_) {
        const auto is_it = [&, number = sequence](const Told& told) { return told.sequence == number; };
        if (std::none_of(story_.all.begin(), story_.all.end(), is_it))
            say("a row of " + std::to_string(sequence) + ", which was never begun");
    }
}

void Judge::verify()
{
    const auto report = store_->verify(
        false, [&](const Finding& finding) { say(std::string{"verify: "} + finding.path + ": " + finding.sentence); },
        [](int, int) {});
    if (!report.ok())
        say(std::string{"verify: "} + report.status().message());
    look_at_quarantine();
    if (store_->start_report().left_over != 0)
        say("something is left over");
}

/// A catalogue may be damaged while it is made for the first time, and at no other moment.
void Judge::look_at_quarantine()
{
    const auto is_stored = [&](const Told& told) { return told.acknowledged <= moment_; };
    const bool is_young = std::none_of(story_.all.begin(), story_.all.end(), is_stored);
    const CardState& state = card_.now();
    for (const auto& [name, number] : state.nodes[static_cast<std::size_t>(state.find("quarantine"))].entries)
        if (!is_young || name.rfind(Store::kCatalogueName, 0) != 0)
            say(name + " is in quarantine");
}

bool Judge::is_idle_start() const
{
    const StartReport& report = store_->start_report();
    return report.finished == 0 && report.interrupted == 0 && report.left_over == 0 && report.rows_added == 0 &&
           !report.catalogue_new;
}

void Judge::store_another()
{
    std::int64_t highest = rows_.empty() ? 0 : rows_.rbegin()->first;
    for (const Told& told : story_.all)
        if (told.begun <= moment_)
            highest = std::max(highest, told.sequence);
    Told another;
    const Status stored = store_snapshot(card_, *store_, kLater, kLaterSeed, kLaterBytes, another);
    if (!stored.ok())
        return say(std::string{"no further snapshot can be stored: "} + stored.message());
    if (another.sequence <= highest)
        say("the sequence " + std::to_string(another.sequence) + " is used again");
    if (!open())
        return;
    if (!is_idle_start())
        say("a start after a clean end found something to mend");
    read_rows();
    if (const std::string what = differs(another, another.contents.back()); !what.empty())
        say("a further snapshot: " + what);
}

Recovered Judge::judge()
{
    if (!open())
        return out_;
    out_.opened = card_.log().size();
    read_rows();
    for (const Told& told : story_.all)
        look_at_each(told);
    look_for_strangers();
    verify();
    store_another();
    return out_;
}

} // namespace

Recovered judge(CrashMedium& card, CrashVfs& vfs, const Story& story, Moment moment)
{
    vfs.use(card);
    return Judge(card, story, moment).judge();
}

} // namespace dicot::test
