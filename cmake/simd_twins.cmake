# simd_twins(NAME [TARGET TARGET] INCLUDE FILE... TYPE TYPE VALUE EXPRESSION [OPTIONS OPTION...]): what the files hold, in an
# anonymous namespace, is compiled twice: for the oldest processor that palpate runs on and for x86-64-v3. Makes
# palpate::simd::kNAMEBaseline and kNAMEV3 of it, equal but for their level, and best_NAME(), the one for this
# processor. On other machines than x86-64 both are one. Only code of a unit's own may be compiled for v3: what is inline elsewhere would be linked everywhere.
include_guard()

function(simd_twins name)
  cmake_parse_arguments(PARSE_ARGV 1 twin "" "TARGET;TYPE;VALUE" "INCLUDE;OPTIONS")
  if(NOT twin_TARGET)
    set(twin_TARGET palpate_core)
  endif()
  string(SUBSTRING ${name} 0 1 first)
  string(SUBSTRING ${name} 1 -1 rest)
  string(TOUPPER ${first} first)
  set(constant k${first}${rest})
  list(TRANSFORM twin_INCLUDE REPLACE "(.+)" "#include \"\\1\"\n")
  string(CONCAT includes ${twin_INCLUDE})
  set(best "const ${twin_TYPE}& best_${name}() noexcept {
  return cpu_has_v3() ? ${constant}V3 : ${constant}Baseline;
}
")
  set(levels V3)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set(levels Baseline V3)
  else()
    string(PREPEND best "constexpr ${twin_TYPE} ${constant}Baseline = ${twin_VALUE};
")
  endif()
  foreach(level ${levels})
    set(file ${CMAKE_CURRENT_BINARY_DIR}/${name}_${level}.cpp)
    file(CONFIGURE OUTPUT ${file} CONTENT "#include \"base/cpu.hpp\"
${includes}
namespace palpate::simd {
constexpr ${twin_TYPE} ${constant}${level} = ${twin_VALUE};
${best}}
" @ONLY)
    set(best "")
    target_sources(${twin_TARGET} PRIVATE ${file})
    set_source_files_properties(${file} TARGET_DIRECTORY ${twin_TARGET} PROPERTIES
      COMPILE_OPTIONS "-O3;${twin_OPTIONS}" SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
  endforeach()
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set_property(SOURCE ${file} TARGET_DIRECTORY ${twin_TARGET} APPEND PROPERTY
      COMPILE_OPTIONS -march=x86-64-v3)
  endif()
endfunction()
