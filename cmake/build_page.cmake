# Builds the page: cmake -D WEB=FOLDER -D PAGE=FOLDER -D NPM=PROGRAM -P build_page.cmake. What npm installs is
# asked for again only when the lock is newer; it lies beside the sources, for all builds of them in turn.
function(run)
  execute_process(COMMAND ${NPM} ${ARGN} WORKING_DIRECTORY ${WEB} RESULT_VARIABLE result
    OUTPUT_VARIABLE words ERROR_VARIABLE words)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "viewer: 'npm ${command}' failed in ${WEB}; without a network, configure with "
      "-DPALPATE_BUILD_PAGE=OFF\n${words}")
  endif()
endfunction()

file(LOCK ${WEB}/node_modules.lock GUARD PROCESS)
set(installed ${WEB}/node_modules/.package-lock.json)  # npm writes it when it is done
if(NOT EXISTS ${installed} OR ${WEB}/package-lock.json IS_NEWER_THAN ${installed})
  run(ci --no-audit --no-fund --ignore-scripts)
endif()
set(ENV{PALPATE_PAGE} ${PAGE})
run(run build)
