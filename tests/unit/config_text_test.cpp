#include "config/config.h"
#include "config/config_keys.h"
#include "config/config_paths.h"
#include "config/config_text.h"
#include "temp_folder.h"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

namespace dicot::app {
namespace {

void expect_same(const Config& got, const Config& wanted)
{
    for (const ConfigKey& key : config_keys())
        EXPECT_EQ(toml_of(key, got), toml_of(key, wanted)) << key.section << "." << key.name;
}

TEST(ConfigText, WhatIsPrintedMeansTheSameInEveryFolder)
{
    const char* const kTexts[] = {
        "",
        R"([cameras]
left = 'serial:"\'
right = '3-1.4'
formats = ['MJPEG']
replay_script = "rate 3\n\tdrop 4 # \u0000\u007f"
[exposure]
lock = false
warm_up_s = 0.7
[rig]
file = 'ä/"b"'
near_mm = 250.125
far_mm = 1000000
)",
        R"([cameras]
left = 'replay:pairs'
right = 'replay:./pairs'
[output]
folder = 'out'
[matching]
gamma_color = 0.5
)",
    };
    for (const char* text : kTexts) {
        const Result<LoadedConfig> first = parse_config(text, "a\nb.toml", "conf");
        ASSERT_TRUE(first.ok()) << first.status().message();
        const std::string printed = config_toml(first.value(), "/here");
        const Result<LoadedConfig> second = parse_config(printed, "b.toml", "/elsewhere");
        ASSERT_TRUE(second.ok()) << second.status().message() << "\n" << printed;
        expect_same(second.value().config, all_taken_from("/here", first.value().config));
    }
}

TEST(ConfigText, PathsArePrintedFromTheRoot)
{
    const std::string text = "[cameras]\nleft = 'replay:a'\nright = 'replay:/b'\n[output]\nfolder = '.'\n";
    const std::string printed = config_toml(parse_config(text, "conf/a.toml", "conf").value(), "/here");
    EXPECT_NE(printed.find("\nleft = \"replay:/here/conf/a\"\n"), std::string::npos) << printed;
    EXPECT_NE(printed.find("\nright = \"replay:/b\"\n"), std::string::npos) << printed;
    EXPECT_NE(printed.find("\nfolder = \"/here/conf\"\n"), std::string::npos) << printed;
}

TEST(ConfigText, EachKeySaysWhereItsValueComesFrom)
{
    const std::string printed = config_toml(parse_config("[burst]\n\nframes = 3\n", "a.toml", "").value(), "/here");
    EXPECT_NE(printed.find("default 8, set in line 3\nframes = 3\n"), std::string::npos) << printed;
    EXPECT_NE(printed.find("default true, not set\naverage = true\n"), std::string::npos) << printed;
    EXPECT_NE(printed.find("# What holds: a.toml, "), std::string::npos) << printed;
}

TEST(ConfigText, TheSampleChangesNothingAndShowsEveryDefault)
{
    const Result<LoadedConfig> as_it_is = parse_config(config_sample(), "sample", "");
    ASSERT_TRUE(as_it_is.ok()) << as_it_is.status().message();
    for (const int line : as_it_is.value().lines)
        EXPECT_EQ(line, 0);

    std::istringstream sample{config_sample()};
    std::string awake;
    for (std::string line; std::getline(sample, line);)
        if (line.size() > 1 && line[0] == '#' && line[1] != ' ' && line.back() != '=')
            awake += line.substr(1) + "\n";
        else
            awake += line + "\n";
    const Result<LoadedConfig> all = parse_config(awake, "sample", "");
    ASSERT_TRUE(all.ok()) << all.status().message();
    expect_same(all.value().config, Config{});
    for (std::size_t i = 0; i < config_keys().size(); ++i)
        EXPECT_EQ(all.value().lines[i] == 0, std::holds_alternative<OpenNumberKey>(config_keys()[i].kind))
            << config_keys()[i].name;
}

TEST(ConfigText, TheSampleInTheCheckoutIsTheProgramsOwn)
{
    const test::Bytes kept = test::bytes_of(DICOT_CONFIG_SAMPLE);
    EXPECT_EQ(std::string(kept.begin(), kept.end()), config_sample())
        << "write it again: dicot config --sample > platform/app/config/dicot.toml";
}

} // namespace
} // namespace dicot::app
