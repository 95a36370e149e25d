// The keys of a rig's description, gathered from one file or several.
#pragma once

#include "yaml_events.h"

#include "dicot/rig/rig_file.h"

#include <span>
#include <string>
#include <string_view>

namespace dicot {

/// Takes documents one after the other; a key may stand once in all of them, unknown keys are passed over.
class RigReader
{
public:
    explicit RigReader(const RigHints& hints) : hints_(hints) {}

    Status take_text(std::span<const std::byte> text, const char* name);
    /// Fault::kNoInput: missing or unreadable.
    Status take_file(const char* path);
    /// Lengths in mm, everything checked. `name` stands for what was read.
    Result<RigFile> finish(const char* name);

private:
    Status take_key(YamlEvents& events, std::string_view key);
    Status take_unit(YamlEvents& events, std::string_view key);
    Status take_id(YamlEvents& events, std::string_view key);
    Status take_time(YamlEvents& events, std::string_view key);
    Status take_rotation_vector(YamlEvents& events, std::string_view key);
    Status take_hints(const char* name);
    Status to_mm(const char* name);
    Status check(const char* name) const;

    RigHints hints_;
    RigFile rig_;
    double mm_per_unit_ = 0; ///< as a file says; 0: none does
};

} // namespace dicot
