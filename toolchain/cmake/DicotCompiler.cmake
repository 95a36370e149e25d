# What every target of dicot is compiled with.
add_library(dicot_compiler INTERFACE)
# Large files and folders on 32 bits too; 64-bit targets have no other.
target_compile_definitions(dicot_compiler INTERFACE _FILE_OFFSET_BITS=64)
target_compile_options(dicot_compiler INTERFACE
  -Wall -Wextra -Wpedantic -Werror -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast
  -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align -Wimplicit-fallthrough
  -Wno-psabi
  # A product and a sum stay two roundings on every CPU: aarch64 would otherwise fuse them, and the bytes would differ.
  -ffp-contract=off
  -fno-strict-aliasing
  $<$<CONFIG:Release>:-O2>)
# clang 14 spells the statement expression of TRY as an extension even behind __extension__ in macros.
target_compile_options(dicot_compiler INTERFACE
  $<$<CXX_COMPILER_ID:Clang>:-Wno-gnu-statement-expression>)

if(DICOT_SANITIZE)
  add_compile_options(-fsanitize=${DICOT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${DICOT_SANITIZE})
endif()

# For sources whose own loops are short, most of what there is to compile: optimising them under AddressSanitizer takes
# three times as long as compiling them.
set(DICOT_COMPILED_QUICKLY "")
if(DICOT_SANITIZE MATCHES "address")
  set(DICOT_COMPILED_QUICKLY -O0)
endif()
