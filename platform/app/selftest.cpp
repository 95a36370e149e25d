// dicot selftest: proves on this board that its vector kernels compute what the scalar law computes.
#include "commands.h"

#include "dicot/proof/proof.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>
#include <random>

namespace dicot::app {
namespace {

struct SelftestWords
{
    std::uint64_t seed = 0;
    bool seeded = false;
    bool json = false;
};

nlohmann::json as_json(const proof::Report& report)
{
    nlohmann::json kernels = nlohmann::json::array();
    for (const proof::Verdict& verdict : report.verdicts())
        kernels.push_back({{"level", verdict.level},
                           {"kernel", verdict.kernel},
                           {"worked_vectors", verdict.worked},
                           {"cases_compared", verdict.compared},
                           {"proven", verdict.proven()},
                           {"fault", verdict.fault},
                           {"unit", verdict.unit},
                           {"units_per_s", verdict.per_second},
                           {"ratio_to_scalar", verdict.ratio}});
    return {{"seed", report.seed()}, {"passed", report.passed()}, {"kernels", kernels}};
}

void print(const proof::Report& report)
{
    std::printf("seed %llu\n", static_cast<unsigned long long>(report.seed()));
    std::printf("%-8s%-17s%8s%10s  %s\n", "level", "kernel", "vectors", "compared", "result");
    for (const proof::Verdict& verdict : report.verdicts()) {
        std::printf("%-8s%-17s%8d%10d  ", verdict.level, verdict.kernel, verdict.worked, verdict.compared);
        if (!verdict.proven())
            std::printf("WRONG: %s\n", verdict.fault[0] != 0 ? verdict.fault : "no case was run");
        else if (verdict.is_law)
            std::printf("right, %.3g %s/s\n", verdict.per_second, verdict.unit);
        else
            std::printf("equal, %.3g %s/s, %.1f x scalar\n", verdict.per_second, verdict.unit, verdict.ratio);
    }
}

Status run(const SelftestWords& words)
{
    const std::uint64_t seed = words.seeded ? words.seed : std::random_device{}();
    const proof::Report report = TRY(proof::prove_this_processor(seed));
    if (words.json)
        std::printf("%s\n", as_json(report).dump(2).c_str());
    else
        print(report);
    if (!report.passed())
        return failure(Fault::kSoftware,
                       "A kernel of this program computes wrongly on this processor; use --cpu scalar, and report what "
                       "'dicot selftest --seed %llu' prints.",
                       static_cast<unsigned long long>(seed));
    return {};
}

} // namespace

void add_selftest(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("selftest", "Prove the vector kernels on this processor");
    auto words = std::make_shared<SelftestWords>();
    command->add_option("--seed", words->seed, "run the cases of an earlier run again")
        ->each([words](const std::string&) { words->seeded = true; });
    command->add_flag("--json", words->json, "report as JSON");
    command->callback([&chosen, words] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
