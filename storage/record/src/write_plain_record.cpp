#include "dicot/record/record.h"

#include "dicot/base/printable.h"
#include "dicot/base/utc_time.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <string_view>

namespace dicot {
namespace {

/// JSON text behind what is there; once it does not fit, nothing more is written.
class Lines
{
public:
    explicit Lines(std::span<char> into) : into_(into) {}

    std::size_t size() const { return whole_ ? size_ : 0; }

    void add(std::string_view text)
    {
        whole_ = whole_ && text.size() <= into_.size() - size_;
        if (!whole_)
            return;
        std::copy(text.begin(), text.end(), into_.data() + size_);
        size_ += text.size();
    }
    void add(std::int64_t number)
    {
        char text[24];
        std::snprintf(text, sizeof text, "%" PRId64, number);
        add(std::string_view{text});
    }
    /// Of printable text, two characters alone must be escaped.
    void add_quoted(std::string_view text)
    {
        char shown[512];
        add("\"");
        for (const char c : std::string_view{shown, printable_into(text, shown)}) {
            if (c == '"' || c == '\\')
                add("\\");
            add(std::string_view{&c, 1});
        }
        add("\"");
    }

private:
    std::span<char> into_;
    std::size_t size_ = 0;
    bool whole_ = true;
};

} // namespace

std::size_t write_plain_record(const RecordFacts& facts, const char* software, std::span<char> into)
{
    Lines lines{into};
    lines.add("{\n  \"clock\": {\n    \"trust\": ");
    lines.add_quoted(facts.clock_trust.view());
    lines.add("\n  },\n");
    if (facts.done) {
        lines.add("  \"cloud\": {\n    \"points\": ");
        lines.add(facts.points);
        lines.add("\n  },\n");
    }
    lines.add("  \"due\": ");
    if (facts.due_us)
        lines.add_quoted(utc_text(*facts.due_us).view());
    else
        lines.add("null");
    lines.add(",\n  \"format\": ");
    lines.add_quoted(kRecordFormat);
    lines.add(",\n  \"outcome\": ");
    lines.add_quoted(facts.done ? "done" : "missed");
    lines.add(",\n  \"reason\": ");
    if (facts.done && facts.reason.empty())
        lines.add("null");
    else
        lines.add_quoted(facts.reason.view());
    lines.add(",\n  \"sequence\": ");
    lines.add(facts.sequence);
    lines.add(",\n  \"software\": ");
    lines.add_quoted(software);
    lines.add(",\n  \"time\": ");
    lines.add_quoted(utc_text(facts.began_us).view());
    lines.add("\n}\n");
    return lines.size();
}

} // namespace dicot
