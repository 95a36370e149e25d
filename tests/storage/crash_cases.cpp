#include "crash_cases.h"

#include "dicot/catalogue/catalogue.h"

#include <algorithm>
#include <cstdio>
#include <set>
#include <stdexcept>
#include <utility>

namespace dicot::test {
namespace {

std::optional<Cut> parse_cut(const std::string& text)
{
    char name[16] = {};
    unsigned at = 0;
    unsigned seed = 0;
    if (std::sscanf(text.c_str(), "%15[a-z]:%u:%u", name, &at, &seed) != 3)
        return {};
    for (const auto mode : {Cut::Mode::kInOrder, Cut::Mode::kSubset, Cut::Mode::kTorn}) {
        const Cut cut{mode, at, seed};
        if (cut.text() == text)
            return cut;
    }
    return {};
}

/// How many of the story's moments have come: what was promised changes with them alone.
std::size_t phase_of(const Story& story, Moment moment)
{
    std::size_t phase = 0;
    for (const Told& told : story.all)
        for (const Moment each : {told.begin_from, told.begun, told.commit_from, told.acknowledged, told.pull_from,
                                  told.pulled, told.prune_from})
            phase += each <= moment ? 1 : 0;
    return phase;
}

/// What the judge did afterwards is not part of it.
std::vector<Change> repair_of(const CrashMedium& card, Moment opened)
{
    return {card.log().begin(), card.log().begin() + static_cast<std::ptrdiff_t>(opened)};
}

class Run
{
public:
    Run(CrashVfs& vfs, const Recording& recording, const CrashPlan& plan)
        : vfs_(vfs), recording_(recording), plan_(plan)
    {
    }

    CrashReport run();

private:
    bool is_done() const { return report_.failures.size() >= plan_.most_failures; }
    bool is_new(const CardState& state, Moment moment)
    {
        return seen_.emplace(state.fingerprint(), phase_of(recording_.story, moment)).second;
    }
    void keep(const CrashCase& which, const Verdict& verdict);
    void cut(const Cut& cut);
    void cut_repair(const Cut& cut, const CrashMedium& repaired, Moment opened);

    CrashVfs& vfs_;
    const Recording& recording_;
    const CrashPlan& plan_;
    CrashReport report_;
    std::set<std::pair<std::uint64_t, std::size_t>> seen_;
};

void Run::keep(const CrashCase& which, const Verdict& verdict)
{
    if (!verdict.empty())
        report_.failures.push_back(words_of(which, verdict));
}

void Run::cut(const Cut& cut)
{
    ++report_.cuts;
    CrashMedium card{surviving({}, recording_.log, cut)};
    if (!is_new(card.start(), cut.at))
        return;
    ++report_.states;
    const Recovered recovered = judge(card, vfs_, recording_.story, cut.at);
    keep({cut, {}}, recovered.verdict);
    if (plan_.repairs_every != 0 && report_.states % plan_.repairs_every == 0)
        cut_repair(cut, card, recovered.opened);
}

void Run::cut_repair(const Cut& cut, const CrashMedium& repaired, Moment opened)
{
    const std::vector<Change> repair = repair_of(repaired, opened);
    Dice dice{cut.at * 31 + cut.seed};
    for (const auto mode : {Cut::Mode::kInOrder, Cut::Mode::kSubset, Cut::Mode::kSubset, Cut::Mode::kTorn}) {
        const Cut second{mode, dice.below(repair.size() + 1),
                         mode == Cut::Mode::kInOrder ? 0U : static_cast<unsigned>(dice.below(100))};
        CrashMedium card{surviving(repaired.start(), repair, second)};
        if (!is_new(card.start(), cut.at))
            continue;
        ++report_.repair_states;
        keep({cut, second}, judge(card, vfs_, recording_.story, cut.at).verdict);
    }
}

CrashReport Run::run()
{
    for (std::size_t at = plan_.from; at <= recording_.log.size(); ++at)
        for (unsigned seed = 0; seed < plan_.seeds && !is_done(); ++seed)
            cut({plan_.mode, at, seed});
    return report_;
}

} // namespace

CrashScene::CrashScene()
{
    if (!Catalogue::open(":memory:", Catalogue::Access::kWrite).ok())
        throw std::runtime_error("no catalogue in memory");
    vfs_ = std::make_unique<CrashVfs>();
}

Recording CrashScene::record(const StoryRules& rules)
{
    CrashMedium card;
    Recording recording;
    recording.story = tell(card, *vfs_, rules);
    recording.log = card.log();
    return recording;
}

Recording CrashScene::record_many(int slots)
{
    StoryRules rules;
    rules.most_file_bytes = 600;
    CrashMedium card;
    Recording recording;
    recording.story = tell_until_full(card, *vfs_, rules, slots);
    recording.log = card.log();
    return recording;
}

std::string CrashCase::text() const
{
    return cut.text() + (repair_cut ? "+" + repair_cut->text() : "");
}

std::optional<CrashCase> CrashCase::parse(const std::string& text)
{
    const std::size_t plus = text.find('+');
    const auto cut = parse_cut(text.substr(0, plus));
    if (!cut)
        return {};
    CrashCase which{*cut, {}};
    if (plus == std::string::npos)
        return which;
    which.repair_cut = parse_cut(text.substr(plus + 1));
    return which.repair_cut ? std::optional{which} : std::nullopt;
}

std::string words_of(const CrashCase& which, const Verdict& verdict)
{
    std::string words = which.text();
    for (const std::string& sentence : verdict)
        words += "\n    " + sentence;
    return words;
}

Verdict run_case(CrashVfs& vfs, const Recording& recording, const CrashCase& which)
{
    CrashMedium card{surviving({}, recording.log, which.cut)};
    const Recovered first = judge(card, vfs, recording.story, which.cut.at);
    if (!which.repair_cut)
        return first.verdict;
    CrashMedium again{surviving(card.start(), repair_of(card, first.opened), *which.repair_cut)};
    return judge(again, vfs, recording.story, which.cut.at).verdict;
}

CrashReport run_plan(CrashVfs& vfs, const Recording& recording, const CrashPlan& plan)
{
    return Run(vfs, recording, plan).run();
}

} // namespace dicot::test
