# Debian packages needed by parts of the build. A part without its packages is left out and listed in the summary of configuring.
# If the part was requested, configuring fails with one line that names the packages and the option.

# lrb_need(PART PACKAGE VARIABLE...): PART needs PACKAGE, which was found if all variables are true. PACKAGE may end in a
# version: "libpng-dev (>= 1.6)".
function(lrb_need part package)
  get_property(known GLOBAL PROPERTY lrb_parts)
  if(NOT part IN_LIST known)
    set_property(GLOBAL APPEND PROPERTY lrb_parts "${part}")
  endif()
  foreach(variable IN LISTS ARGN)
    if(NOT ${variable})
      set_property(GLOBAL APPEND PROPERTY "lrb_lacks_${part}" "${package}")
      return()
    endif()
  endforeach()
endfunction()

# Sets the caller's VARIABLE to the list of packages that the parts lack.
function(lrb_lacking variable)
  set(all "")
  foreach(part IN LISTS ARGN)
    get_property(packages GLOBAL PROPERTY "lrb_lacks_${part}")
    list(APPEND all ${packages})
  endforeach()
  list(REMOVE_DUPLICATES all)
  set(${variable} "${all}" PARENT_SCOPE)
endfunction()

# lrb_part(WANTED OPTION PART [OTHER...]): returns from the calling CMakeLists.txt if PART, or another part that it needs, lacks
# packages. If WANTED is ON, configuring fails; OPTION is the option that leaves the part out.
macro(lrb_part wanted option part)
  lrb_lacking(lrb_lacks "${part}" ${ARGN})
  if(lrb_lacks)
    if("${wanted}" STREQUAL "AUTO" OR NOT "${wanted}")
      set_property(GLOBAL PROPERTY "lrb_lacks_${part}" "${lrb_lacks}")
      return()
    endif()
    list(JOIN lrb_lacks ", " lrb_lacks)
    # A leading space keeps CMake from breaking the line.
    message(FATAL_ERROR " lrbscope: ${part} needs Debian's ${lrb_lacks}: install them or equivalents, or configure with ${option}")
  endif()
endmacro()

# Prints the parts that will be built, and those left out with the missing packages.
function(lrb_summary)
  set(built "")
  foreach(pair IN ITEMS lrb_engine:engine lrb_trace:trace lrb_render:render lrbscope:program lrb_python:Python lrb_test_main:tests)
    string(REPLACE ":" ";" pair ${pair})
    list(GET pair 0 target)
    list(GET pair 1 name)
    if(TARGET ${target})
      list(APPEND built ${name})
    endif()
  endforeach()
  list(JOIN built ", " built)
  message(STATUS "lrbscope ${PROJECT_VERSION} (${CMAKE_BUILD_TYPE}, ${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}): ${built}")
  get_property(parts GLOBAL PROPERTY lrb_parts)
  foreach(part IN LISTS parts)
    lrb_lacking(lacks "${part}")
    if(lacks)
      list(JOIN lacks ", " lacks)
      message(STATUS "left out: ${part}, needs Debian's ${lacks}")
    endif()
  endforeach()
endfunction()
