# The workers that put cases to methods, ours (own/) and engines of others (peers/), found where their Debian packages are
# installed. They are built beside lrbscope, which starts them, and never installed: CGAL's licence is GPL, so nothing of
# ours may contain it.

# lrb_add_peer(NAME [SOURCE NAME.cpp] [PROGRAM lrbscope-methods] HAS MACRO [LIBRARIES ...]): an engine of another's, with
# SOURCE, which defines NAME_methods() (see lrb_registry), in a library lrb_peer_NAME of its own, for what that engine wants
# of the compiler; its headers are not held to our warnings. MACRO is defined if it was found: if LIBRARIES names any.
# Two engines that define the same symbols need programs of their own: any name that begins with "lrbscope-methods".
function(lrb_add_peer name)
  cmake_parse_arguments(peer "" "SOURCE;PROGRAM;HAS" "LIBRARIES" ${ARGN})
  if(NOT peer_SOURCE)
    set(peer_SOURCE ${name}.cpp)
  endif()
  if(NOT peer_PROGRAM)
    set(peer_PROGRAM lrbscope-methods)
  endif()
  add_library(lrb_peer_${name} STATIC methods/peers/${peer_SOURCE})
  target_link_libraries(lrb_peer_${name} PUBLIC lrb::methods PRIVATE ${peer_LIBRARIES})
  if(peer_LIBRARIES)
    target_compile_definitions(lrb_peer_${name} PRIVATE ${peer_HAS})
    target_compile_options(lrb_peer_${name} PRIVATE -w)
  endif()
  set_property(GLOBAL APPEND PROPERTY lrb_worker_programs ${peer_PROGRAM})
  set_property(GLOBAL APPEND PROPERTY lrb_peers_of_${peer_PROGRAM} ${name})
endfunction()

file(GLOB LRB_PEERS CONFIGURE_DEPENDS methods/peers/*.cmake)
foreach(peer IN LISTS LRB_PEERS)
  include("${peer}")
endforeach()

file(GLOB own CONFIGURE_DEPENDS methods/own/*.cpp)
set_property(GLOBAL PROPERTY lrb_own_methods ${own})
add_library(lrb_own_methods STATIC ${own})
target_link_libraries(lrb_own_methods PUBLIC lrb::methods)

# lrb_register_methods(TARGET [PEER...]): gives a program our methods, if it is not one of the further workers, and those of
# the peers; registered_methods() has them.
function(lrb_register_methods target)
  set(names ${ARGN})
  foreach(name IN LISTS names)
    target_link_libraries(${target} PRIVATE lrb_peer_${name})
  endforeach()
  if(NOT target MATCHES "^lrbscope-methods-")
    get_property(own GLOBAL PROPERTY lrb_own_methods)
    list(APPEND names ${own})
    target_link_libraries(${target} PRIVATE lrb_own_methods)
  endif()
  lrb_registry(${target} lrb::methods scenarios/methods/method.hpp MethodEntry methods ${names})
endfunction()

add_library(lrb_asked_cases STATIC worker_programs/asked_cases.cpp)
target_link_libraries(lrb_asked_cases PUBLIC lrb::stability CLI11::CLI11 lrb_options)
add_library(lrb_worker_programs STATIC worker_programs/fake_methods.cpp worker_programs/worker.cpp)
target_link_libraries(lrb_worker_programs PUBLIC lrb_asked_cases lrb::bench)

get_property(LRB_WORKER_PROGRAMS GLOBAL PROPERTY lrb_worker_programs)
list(APPEND LRB_WORKER_PROGRAMS lrbscope-methods)
list(REMOVE_DUPLICATES LRB_WORKER_PROGRAMS)
foreach(program IN LISTS LRB_WORKER_PROGRAMS)
  get_property(names GLOBAL PROPERTY lrb_peers_of_${program})
  add_executable(${program} worker_programs/worker_main.cpp)
  target_link_libraries(${program} PRIVATE lrb_worker_programs)
  lrb_register_methods(${program} ${names})
endforeach()

# What makes the simplification that `levels` compares wrappers with, where CGAL is installed.
if(CGAL_FOUND)
  find_package(Eigen3 3.3 REQUIRED NO_MODULE)
  add_executable(lrbscope-simplify worker_programs/simplify.cpp)
  target_link_libraries(lrbscope-simplify PRIVATE CGAL::CGAL Eigen3::Eigen)
  target_compile_definitions(lrbscope-simplify PRIVATE NDEBUG)
  target_compile_features(lrbscope-simplify PRIVATE cxx_std_20)
  target_compile_options(lrbscope-simplify PRIVATE -w)
endif()

# What records other engines' walks for `xray`, where they are installed.
foreach(engine IN ITEMS fcl cgal)
  if(NOT ${engine}_library)
    continue()
  endif()
  add_executable(lrbscope-xray-${engine} worker_programs/xray_${engine}.cpp)
  target_link_libraries(lrbscope-xray-${engine} PRIVATE ${${engine}_library})
  target_include_directories(lrbscope-xray-${engine} PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_definitions(lrbscope-xray-${engine} PRIVATE NDEBUG)
  target_compile_features(lrbscope-xray-${engine} PRIVATE cxx_std_20)
  target_compile_options(lrbscope-xray-${engine} PRIVATE -w)
endforeach()
