// The name that a rig's geometry gives itself.
#pragma once

#include "dicot/rig/rig_file.h"

#include <array>

namespace dicot {

/// "rig-" and 16 hexadecimal digits.
using RigId = std::array<char, 21>;

/// The same for the same geometry, everywhere: the beginning of the SHA-256 of the picture size and of K1 D1 K2 D2 R T,
/// or, where these do not describe both cameras, of P1 and P2 (storage/FORMAT.md has the bytes). Dates, quality,
/// working range and the way of rectifying make no difference.
RigId rig_id_of(const RigFile& rig);

/// Puts rig_id_of() into `rig.id`.
void set_id(RigFile& rig);

/// False when `id` looks like one of rig_id_of() but is that of other numbers: the file was edited by hand. A name of
/// any other form matches everything.
bool id_matches(const RigFile& rig);

} // namespace dicot
