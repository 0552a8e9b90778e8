# What every target of ours is compiled with. Warnings become errors in the presets only.
set(PALPATE_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor)
# g++ 12 sees strings overlap inside std::string's own operator+ (GCC bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  list(APPEND PALPATE_WARNINGS -Wno-restrict)
endif()

# Loops that gain from AVX2 are compiled a second time by their owners and chosen at run time.
set(PALPATE_BASELINE x86-64-v2 CACHE STRING
  "The oldest x86-64 processor that runs palpate, as -march names it (x86-64-v2: SSE4.2, of 2009)")
set(palpate_march)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
  set(palpate_march -march=${PALPATE_BASELINE})
endif()

# Eigen adds three numbers in another order where a machine has vectors of two, and forces differ in their last bits from
# one kind of machine to another. All targets agree on it: of an inline function that several objects hold the linker
# keeps the first. What Eigen aligns stays the same for those who include our headers.
option(PALPATE_PORTABLE_BITS "Forces of the same bits on all kinds of machines; a step takes 6 to 7 % longer on x86-64-v3" OFF)
set(palpate_eigen)
if(PALPATE_PORTABLE_BITS)
  set(palpate_eigen EIGEN_DONT_VECTORIZE EIGEN_MAX_STATIC_ALIGN_BYTES=16)
endif()

# -ffp-contract=off: no fused multiply-add behind our backs, so that the same input gives the same
# forces bit for bit at every level of the instruction set (docs/architecture.md, contract 4).
function(palpate_target target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PRIVATE
    ${PALPATE_WARNINGS} ${palpate_march} -ffp-contract=off)
  target_compile_definitions(${target} PRIVATE ${palpate_eigen})
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
endfunction()

# Is this a build with a sanitizer? Such a build replaces malloc and handles signals itself.
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  set(PALPATE_SANITIZED ON)
else()
  set(PALPATE_SANITIZED OFF)
endif()

# The optimisation of what computes no force: a release build's -O3 takes a compiler a third longer. For whole
# programs, or sources whose headers nobody else includes: of an inline function that several objects hold the linker
# keeps the first.
set(PALPATE_LIGHT "")
if(PALPATE_SANITIZED)
  set(PALPATE_LIGHT -O0)
elseif(CMAKE_BUILD_TYPE STREQUAL "Release")
  set(PALPATE_LIGHT -O1)
  # g++ looks through all of a precompiled header whenever it collects garbage, a tenth of its time in units of many
  # templates: it first does at 1 GB (in kB).
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    list(APPEND PALPATE_LIGHT --param=ggc-min-heapsize=1000000)
  endif()
endif()

# Sources that compute no force and include headers that a compiler takes long for.
function(palpate_slow_header target)
  set_source_files_properties(${ARGN} TARGET_DIRECTORY ${target} PROPERTIES
    SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON COMPILE_OPTIONS "${PALPATE_LIGHT}")
endfunction()

# palpate_precompile(TARGET [HEADER...]): what nearly all sources include is read once a target. Sources still include
# all that they use: scripts/lint.sh looks at them without.
function(palpate_precompile target)
  target_precompile_headers(${target} PRIVATE <algorithm> <array> <atomic> <chrono> <cmath> <cstdint> <filesystem>
    <fstream> <functional> <memory> <mutex> <optional> <span> <sstream> <string> <string_view> <thread> <utility>
    <variant> <vector> <Eigen/Dense> <fmt/format.h> ${ARGN})
endfunction()

# Objects that may become part of a shared library of ours. The Python module is such a one that holds them, and who
# installs Python's headers later need not compile all of it again. What nothing can replace may be inlined as before.
function(palpate_objects target)
  palpate_target(${target})
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  if(NOT EMSCRIPTEN)
    target_compile_options(${target} PRIVATE -fno-semantic-interposition)
  endif()
endfunction()

# A library of ours. Where it is a shared one, it shows the names of palpate and nothing of what it is made with.
function(palpate_library target name)
  palpate_objects(${target})
  add_library(palpate::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name}
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  # One precompiled header serves all of them, so none has a name of its own defined.
  set_target_properties(${target} PROPERTIES DEFINE_SYMBOL "")
  if(BUILD_SHARED_LIBS)
    target_link_options(${target} PRIVATE -Wl,--version-script=${PROJECT_SOURCE_DIR}/cmake/exported.map)
    set_target_properties(${target} PROPERTIES INSTALL_RPATH $ORIGIN
      LINK_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/exported.map)
  endif()
endfunction()
