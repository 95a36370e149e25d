// CloudMeta and CloudGrid as the key and text pairs of a file's metadata.
#pragma once

#include "dicot/base/cloud.h"
#include "dicot/codec/cloud_meta.h"

#include <string_view>

namespace dicot {

struct MetaEntry
{
    const char* key = "";
    CloudMeta::Text text;
};

struct MetaEntries
{
    static constexpr int kMost = 16;
    MetaEntry entries[kMost];
    int count = 0;
};

/// All entries of a file: what is known, the unit, the frame and the grid.
MetaEntries entries_of(const CloudMeta& meta, const CloudGrid& grid);

/// Takes one entry of a file; keys of others are passed over. False: the text is not one of this key.
bool take_entry(std::string_view key, std::string_view text, CloudMeta& meta, CloudGrid& grid);

/// Keys without which a cloud cannot be read, as bits of `seen`.
enum GridKey : unsigned
{
    kSeenUnit = 1,
    kSeenStep = 2,
    kSeenBits = 4,
    kSeenOrigin = 8,
    kSeenAll = 15
};
unsigned grid_key(std::string_view key);

} // namespace dicot
