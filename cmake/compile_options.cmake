# What every target of ours is compiled with. Warnings become errors in the presets only.
#
# -ffp-contract=off: the same input gives the same forces bit for bit, on every level of the
# instruction set (architecture.md, contract 5).
set(PALPATE_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor)

function(palpate_target target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PRIVATE ${PALPATE_WARNINGS} -ffp-contract=off)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
endfunction()
