#include "dicot/base/printable.h"
#include "dicot/os/heap_gate.h"
#include "dicot/os/memory_block.h"
#include "dicot/record/record.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

namespace dicot {
namespace {

constexpr const char* kDone = R"({
  "calibration_id": "rig-0123456789abcdef",
  "cameras": {"plan": {"why": "both at once"}, "points": -1, "trust": [1, {"points": 2.5}]},
  "clock": {"trust": "network", "offset_us": -3, "points": "many"},
  "cloud": {"points": 137130, "stages_s": {"points": 0.2, "read": 1e300}, "trust": null},
  "due": "2026-06-01T12:00:00Z",
  "format": "dicot record 1",
  "outcome": "done",
  "reason": null,
  "sequence": 17,
  "time": "2026-06-01T12:00:03Z",
  "warnings": ["sequence", {"time": "sequence"}]
})";

Result<RecordFacts> read(const std::string& text)
{
    static const MemoryBlock heap = MemoryBlock::map(kRecordHeapBytes).value();
    return read_record(std::as_bytes(std::span{text}), "record.json", heap.bytes());
}

std::string with(std::string text, const std::string& what, const std::string& instead)
{
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), instead);
}

TEST(Record, SaysWhatItsKeysSay)
{
    const Result<RecordFacts> facts = read(kDone);
    ASSERT_TRUE(facts.ok()) << facts.status().message();
    RecordFacts expected;
    expected.sequence = 17;
    expected.began_us = 1'780'315'203'000'000; // date -u -d 2026-06-01T12:00:03Z +%s
    expected.due_us = 1'780'315'200'000'000;
    expected.done = true;
    expected.clock_trust = "network";
    expected.points = 137130;
    EXPECT_EQ(facts.value(), expected);
}

TEST(Record, AMissNeedsItsReasonAndNoCloud)
{
    const std::string done = with(kDone, "\"cloud\"", "\"no cloud\"");
    EXPECT_EQ(read(done).status().fault(), Fault::kBadData);
    const std::string missed = with(done, "\"done\"", "\"missed\"");
    EXPECT_EQ(read(missed).status().fault(), Fault::kBadData);
    const std::string long_reason = R"("reason": "a\u0007b\"c)" + std::string(260, 'x') + "\"";
    const Result<RecordFacts> facts = read(with(missed, "\"reason\": null", long_reason));
    ASSERT_TRUE(facts.ok()) << facts.status().message();
    EXPECT_FALSE(facts.value().done);
    EXPECT_EQ(facts.value().reason.view().size(), 255U);
    EXPECT_TRUE(facts.value().reason.view().starts_with("a\uFFFDb\"cxxx"));
}

TEST(Record, RefusesWhatItCannotBelieveAndNamesTheFile)
{
    const std::pair<const char*, const char*> wrong[] = {
        {"dicot record 1", "dicot record 2"},
        {"\"format\"", "\"Format\""},
        {"\"sequence\": 17", "\"sequence\": 0"},
        {"\"sequence\": 17", "\"sequence\": -17"},
        {"\"sequence\": 17", "\"sequence\": 17.0"},
        {"\"sequence\": 17", "\"sequence\": \"17\""},
        {"\"sequence\": 17", "\"sequence\": 1000000000"},
        {"\"sequence\": 17", "\"sequence\": 18446744073709551617"},
        {"\"sequence\": 17", "\"sequence\": null"},
        {"\"sequence\": 17", "\"sequence\": [17]"},
        {"\"sequence\": 17", "\"sequence\": 17, \"sequence\": 17"},
        {"\"sequence\": 17,", ""},
        {"12:00:03Z", "12:00:03"},
        {"12:00:03Z", "12:00:63Z"},
        {"\"2026-06-01T12:00:00Z\"", "0"},
        {"\"done\"", "\"maybe\""},
        {"\"done\"", "true"},
        {"\"outcome\"", "\"out\""},
        {"\"clock\": {", "\"clock\": 1, \"c\": {"},
        {"\"network\"", "\"a trust that is longer than any of dicot's own\""},
        {"\"network\"", "\"net\\nwork\""},
        {"\"network\"", "3"},
        {"{\"trust\": \"n", "{\"mistrust\": \"n"},
        {"137130", "-1"},
        {"137130", "4294967296"},
        {"137130", "1e3"},
        {"\"reason\": null", "\"reason\": 1"},
        {"{\n", "[{\n"},
        {"0.2, ", "0.2 "},
        {"\"sequence\", {", "\"\xFF\", {"},
    };
    for (const auto& [what, instead] : wrong) {
        const Result<RecordFacts> facts = read(with(kDone, what, instead));
        EXPECT_EQ(facts.status().fault(), Fault::kBadData) << what << " -> " << instead;
        EXPECT_EQ(std::string{facts.status().message()}.rfind("record.json: ", 0), 0U) << facts.status().message();
    }
    for (const std::string text : {"", "17", "null", "[]", "\"x\"", "{}"})
        EXPECT_EQ(read(text).status().fault(), Fault::kBadData) << text;
    EXPECT_EQ(read(std::string{kDone} + "x").status().fault(), Fault::kBadData);
}

TEST(Record, RefusesDepthAndLengthBeforeTheyHurt)
{
    const auto nested = [](int levels) {
        const auto many = static_cast<std::size_t>(levels);
        return with(kDone, "[\"sequence\"", "[" + std::string(many, '[') + std::string(many, ']') + ", \"sequence\"");
    };
    EXPECT_TRUE(read(nested(30)).ok());
    EXPECT_FALSE(read(nested(31)).ok());
    EXPECT_FALSE(read(nested(100'000)).ok());
    const std::string blanks = std::string{kDone} + std::string(kMaxRecordBytes - std::string{kDone}.size(), ' ');
    EXPECT_TRUE(read(blanks).ok());
    EXPECT_FALSE(read(blanks + " ").ok());
}

TEST(Record, IsReadWithinTheLentHeapAloneWhateverItIs)
{
    if (!heap_gate::replaces_operator_new()) {
        std::printf("NOT RUN: sanitizers bring their own operator new, so no heap can be lent\n");
        return;
    }
    const std::size_t room = kMaxRecordBytes - std::string{kDone}.size() - 200;
    const std::string quote = "\"";
    const std::string sound[] = {
        kDone,
        with(kDone, "\"both at once\"", quote + std::string(room, 'x') + quote),
        with(kDone, "\"both at once\"",
             quote + std::string(room / 2, 'x') + "\", \"" + std::string(room / 2, 'y') + "\": 1"),
        with(kDone, "\"both at once\"", "0." + std::string(room, '1')),
        with(kDone, "\"both at once\"", std::string(room, '\n') + "null"),
    };
    const std::string unsound[] = {
        std::string(kMaxRecordBytes, '['),
        std::string(kMaxRecordBytes, '\n'),
        "{\"a\": " + std::string(kMaxRecordBytes - 10, '\n') + "nul",
        "{\"a\": \"" + std::string(kMaxRecordBytes - 10, 'x') + "\x01",
        std::string(kMaxRecordBytes, '\xFF'),
    };
    const MemoryBlock heap = MemoryBlock::map(kRecordHeapBytes).value();
    std::vector<bool> read_well;
    read_well.reserve(16);
    heap_gate::seal(heap_gate::Breach::kCount);
    for (const std::string& text : sound)
        read_well.push_back(read_record(std::as_bytes(std::span{text}), "r", heap.bytes()).ok());
    for (const std::string& text : unsound)
        read_well.push_back(read_record(std::as_bytes(std::span{text}), "r", heap.bytes()).ok());
    const bool small_is_refused =
        !read_record(std::as_bytes(std::span{sound[1]}), "r", heap.bytes().first(100'000)).ok();
    const std::uint64_t breaches = heap_gate::breaches();
    heap_gate::unseal();
    EXPECT_EQ(breaches, 0U);
    EXPECT_TRUE(small_is_refused);
    EXPECT_EQ(read_well, (std::vector<bool>{true, true, true, true, true, false, false, false, false, false}));
}

TEST(Record, ThePlainOneIsReadBackAsItWasWritten)
{
    RecordFacts facts;
    facts.sequence = 999'999'999;
    facts.began_us = -62'167'219'200'000'000; // 0000-01-01
    facts.reason = "power went \"away\" \\ in the middle – 葉";
    facts.clock_trust = "none";
    std::vector<char> text(kMaxPlainRecordBytes);
    const auto back = [&] {
        const std::size_t size = write_plain_record(facts, "dicot \"0.1.0\"", text);
        EXPECT_GT(size, 0U);
        return read(std::string(text.data(), size));
    };
    const Result<RecordFacts> missed = back();
    ASSERT_TRUE(missed.ok()) << missed.status().message();
    EXPECT_EQ(missed.value(), facts);
    facts.due_us = 253'402'300'799'000'000; // 9999-12-31T23:59:59Z
    facts.done = true;
    facts.points = 4294967295;
    facts.reason = "";
    const Result<RecordFacts> done = back();
    ASSERT_TRUE(done.ok()) << done.status().message();
    EXPECT_EQ(done.value(), facts);

    facts.reason = std::string_view{std::string(255, '"')};
    const std::size_t size = write_plain_record(facts, std::string(600, '\\').c_str(), text);
    EXPECT_GT(size, 0U);
    EXPECT_TRUE(read(std::string(text.data(), size)).ok());
    for (std::size_t room = 0; room < size; ++room)
        EXPECT_EQ(write_plain_record(facts, std::string(600, '\\').c_str(), std::span{text}.first(room)), 0U);
}

TEST(Printable, LeavesWhatCanBeReadAndMarksTheRest)
{
    const std::pair<std::string, std::string> cases[] = {
        {"caméra – 葉 😀 ~", "caméra – 葉 😀 ~"},
        {"a\tb\n", "a\uFFFDb\uFFFD"},
        {"\x7F\xC2\x85\xC2\xA0", "\uFFFD\uFFFD\xC2\xA0"},
        {"\xC0\xAF|\xE0\x80\xAF|\xED\xA0\x80|\xF4\x90\x80\x80|", // too long, surrogates, beyond the last one
         "\uFFFD\uFFFD|\uFFFD\uFFFD\uFFFD|\uFFFD\uFFFD\uFFFD|\uFFFD\uFFFD\uFFFD\uFFFD|"},
        {"\xE2\x82x\xF0\x9F\x98", "\uFFFDx\uFFFD"},
        {"abc\u202Efed", "abc\uFFFDfed"},
        {std::string("a\0b", 3), "a\uFFFDb"},
    };
    for (const auto& [text, shown] : cases) {
        EXPECT_EQ(printable<64>(text).view(), shown);
        EXPECT_EQ(is_printable(text), text == shown) << shown;
        EXPECT_TRUE(is_printable(shown));
    }
    EXPECT_EQ(printable<4>("abcé").view(), "abc");
    EXPECT_EQ(printable<4>("ab\n").view(), "ab");
}

} // namespace
} // namespace dicot
