// The events of a record's JSON, one after the other, into facts.
#pragma once

#include "dicot/record/record.h"

#include <nlohmann/json.hpp>

#include <array>
#include <string>
#include <string_view>

namespace dicot {

/// What nlohmann's reader calls. It stops the reading at the first fault.
class RecordSax : public nlohmann::json_sax<nlohmann::json>
{
public:
    /// What is wrong, in a few words; null: nothing, and the facts are complete.
    const char* complaint() const;
    const RecordFacts& facts() const { return facts_; }

    bool null() override;
    bool boolean(bool value) override;
    bool number_integer(std::int64_t value) override;
    bool number_unsigned(std::uint64_t value) override;
    bool number_float(double value, const std::string& text) override;
    bool string(std::string& value) override;
    bool binary(nlohmann::json::binary_t& value) override;
    bool start_object(std::size_t elements) override;
    bool key(std::string& name) override;
    bool end_object() override;
    bool start_array(std::size_t elements) override;
    bool end_array() override;
    bool parse_error(std::size_t place, const std::string& token, const nlohmann::detail::exception& why) override;

private:
    /// The keys that matter.
    enum class Key
    {
        kFormat,
        kSequence,
        kTime,
        kDue,
        kOutcome,
        kReason,
        kClock,
        kTrust,
        kCloud,
        kPoints,
        kOther,
    };
    static constexpr std::size_t kKeys = static_cast<std::size_t>(Key::kOther);

    static Key key_of(std::string_view name, Key around);
    bool refuse(const char* why);
    bool enter(bool object);
    bool leave();
    bool other_type();
    bool take_text(std::string_view text);
    bool has(Key key) const { return seen_[static_cast<std::size_t>(key)]; }

    RecordFacts facts_;
    const char* fault_ = nullptr;
    int depth_ = 0;
    Key around_ = Key::kOther; ///< the object at the first level that is open
    Key key_ = Key::kOther;    ///< whose value comes next
    std::array<bool, kKeys> seen_{};
    bool has_reason_ = false; ///< one that is text
};

} // namespace dicot
