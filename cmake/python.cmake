# The Python module: which Python it is for, and whether all that it needs is there. PALPATE_PYTHON names the
# program; unset, it is the first python3 that has NumPy, and where anything is absent palpate is built without.
set(PALPATE_PYTHON "" CACHE FILEPATH "Python that the module is for; empty: the first that has NumPy")

# Sets `result` to the first python3, of PATH or the system's, that can import numpy.
function(palpate_find_python result)
  find_program(on_path python3 NO_CACHE)
  foreach(program ${on_path} /usr/bin/python3)
    execute_process(COMMAND ${program} -c "import numpy" RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
    if(NOT failed)
      set(${result} ${program} PARENT_SCOPE)
      return()
    endif()
  endforeach()
endfunction()

if(PALPATE_PYTHON)
  set(Python_EXECUTABLE ${PALPATE_PYTHON})
  set(needed REQUIRED)
else()
  palpate_find_python(Python_EXECUTABLE)
  set(needed QUIET)
endif()
set(PYBIND11_NOPYTHON ON)  # which Python it is, is said here
find_package(Python 3.9 COMPONENTS Interpreter Development.Module ${needed})
find_package(pybind11 2.10 ${needed})
if(NOT Python_Development.Module_FOUND OR NOT pybind11_FOUND)
  message(STATUS "python: pybind11-dev, python3-dev or python3-numpy is absent; built without a Python module")
  set(PALPATE_BUILD_PYTHON OFF)
elseif(CMAKE_CXX_FLAGS MATCHES "-fsanitize=thread")
  set(PALPATE_BUILD_PYTHON OFF)  # Python itself is not instrumented
endif()

# What a Python without sanitizers has to load before a module with them.
if(PALPATE_BUILD_PYTHON AND PALPATE_SANITIZED)
  set(library libasan.so)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    set(library libclang_rt.asan-x86_64.so)
  endif()
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=${library}
    OUTPUT_VARIABLE PALPATE_ASAN_LIBRARY OUTPUT_STRIP_TRAILING_WHITESPACE)
endif()
