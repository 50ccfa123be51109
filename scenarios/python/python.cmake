# The Python module: the package lrbscope in build/.../python, by pybind11, where Python's and pybind11's headers are. The system's
# Python is meant, for which Debian's packages are, even if another comes first in PATH; -DPython3_EXECUTABLE names another.
option(LRB_PYTHON "Build the Python module, where Python and pybind11 are installed" ON)
set(LRB_PYTHON_DIR lib/python3/dist-packages CACHE STRING "Where the Python package is installed, below the prefix")
set(LRB_PYTHON_EXECUTABLE "" CACHE INTERNAL "The Python that the module is for; empty: there is no module")

function(lrb_find_python)
  if(NOT LRB_PYTHON OR LRB_SANITIZE OR LRB_FUZZ)
    return()
  endif()
  if(NOT Python3_EXECUTABLE AND NOT SKBUILD AND EXISTS /usr/bin/python3)
    set(Python3_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "The Python to build the module for")
  endif()
  find_package(Python3 3.9 QUIET COMPONENTS Interpreter Development.Module)
  find_package(pybind11 2.10 CONFIG QUIET)
  lrb_need("Python module" "python3-dev (>= 3.9)" Python3_Development.Module_FOUND)
  lrb_need("Python module" "pybind11-dev (>= 2.10)" pybind11_FOUND)
  if(Python3_Development.Module_FOUND AND pybind11_FOUND)
    set(LRB_PYTHON_EXECUTABLE "${Python3_EXECUTABLE}" CACHE INTERNAL "")
    set(LRB_PYTHON_MINOR ${Python3_VERSION_MINOR} CACHE INTERNAL "Its version's second number, for cmake/debs.cmake")
  endif()
endfunction()

lrb_find_python()
if(SKBUILD)
  lrb_part(ON "-DPython3_EXECUTABLE=... of another Python" "Python module")
endif()
if(NOT LRB_PYTHON_EXECUTABLE)
  return()
endif()
message(STATUS "Python module: for ${LRB_PYTHON_EXECUTABLE}")

set(lrb_python_out ${PROJECT_BINARY_DIR}/python/lrbscope)
file(GLOB lrb_python_sources CONFIGURE_DEPENDS python/*.cpp)
pybind11_add_module(lrb_python MODULE NO_EXTRAS ${lrb_python_sources})
# gcc 12 sees members of pybind11's casters as uninitialized that are read only if set.
target_compile_options(lrb_python PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
if(CMAKE_BUILD_TYPE STREQUAL "Release")
  target_compile_options(lrb_python PRIVATE -O2)  # the work is done in the engine
endif()
target_precompile_headers(lrb_python PRIVATE <algorithm> <functional> <memory> <span> <string> <vector> <Eigen/Core>
                          <Eigen/Geometry> <pybind11/numpy.h> <pybind11/pybind11.h> <pybind11/stl.h>)
target_link_libraries(lrb_python PRIVATE lrb::run lrb::bodies lrb_options)
# What the module has beside its entry is its own: no other module's code is taken for it.
target_link_options(lrb_python PRIVATE LINKER:--exclude-libs,ALL)
set_target_properties(lrb_python PROPERTIES OUTPUT_NAME _core LIBRARY_OUTPUT_DIRECTORY ${lrb_python_out} UNITY_BUILD OFF)

file(GLOB lrb_python_files CONFIGURE_DEPENDS python/lrbscope/*.py python/lrbscope/*.pyi python/lrbscope/py.typed)
set(lrb_python_copies "")
foreach(file IN LISTS lrb_python_files)
  get_filename_component(name ${file} NAME)
  add_custom_command(OUTPUT ${lrb_python_out}/${name} COMMAND ${CMAKE_COMMAND} -E copy ${file} ${lrb_python_out}/${name} DEPENDS ${file})
  list(APPEND lrb_python_copies ${lrb_python_out}/${name})
endforeach()
add_custom_target(lrb_python_package ALL DEPENDS ${lrb_python_copies})
add_dependencies(lrb_python_package lrb_python)

if(SKBUILD)
  set(LRB_PYTHON_DIR .)  # scikit-build-core makes a wheel of what is installed
endif()
install(TARGETS lrb_python LIBRARY DESTINATION ${LRB_PYTHON_DIR}/lrbscope COMPONENT python OPTIONAL)
install(FILES ${lrb_python_files} DESTINATION ${LRB_PYTHON_DIR}/lrbscope COMPONENT python)
