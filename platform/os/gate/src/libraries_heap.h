// Behind malloc: the system's heap, then the libraries' arena.
#pragma once

#include "dicot/os/heap_gate.h"

// A sanitizer brings its own malloc and operator new.
#if defined(__has_feature)
#define DICOT_HAS_FEATURE(feature) __has_feature(feature)
#else
#define DICOT_HAS_FEATURE(feature) 0
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || DICOT_HAS_FEATURE(address_sanitizer) ||           \
    DICOT_HAS_FEATURE(thread_sanitizer) || DICOT_HAS_FEATURE(memory_sanitizer)
#define DICOT_GATE_REPLACES 0
#else
#define DICOT_GATE_REPLACES 1
#endif

namespace dicot::heap_gate {

/// malloc's door is shut: from now on `arena` serves.
void shut_malloc(std::span<std::byte> arena) noexcept;
void open_malloc() noexcept;

} // namespace dicot::heap_gate
