# The workers that run cases with all methods, lrbscope's and other engines', found by their Debian packages.
# They are built beside lrbscope, which starts them, and never installed: CGAL's licence is GPL, so no part of
# lrbscope may contain it.

# lrb_add_peer(NAME [SOURCE NAME.cpp] [PROGRAM lrbscope-methods] HAS MACRO [LIBRARIES ...]): another engine.
# SOURCE defines NAME_methods() (see lrb_registry) and is compiled into the separate library lrb_peer_NAME,
# with the compiler options of that engine; its headers are exempt from lrbscope's warnings. MACRO is defined
# if the engine was found, that is, if LIBRARIES names any. Two engines that define the same symbols need
# separate programs: any name that begins with "lrbscope-methods".
function(lrb_add_peer name)
  cmake_parse_arguments(peer "" "SOURCE;PROGRAM;HAS" "LIBRARIES" ${ARGN})
  if(NOT peer_SOURCE)
    set(peer_SOURCE ${name}.cpp)
  endif()
  if(NOT peer_PROGRAM)
    set(peer_PROGRAM lrbscope-methods)
  endif()
  add_library(lrb_peer_${name} STATIC methods/${peer_SOURCE})
  target_link_libraries(lrb_peer_${name} PUBLIC lrb::methods PRIVATE ${peer_LIBRARIES})
  if(peer_LIBRARIES)
    target_compile_definitions(lrb_peer_${name} PRIVATE ${peer_HAS})
    target_compile_options(lrb_peer_${name} PRIVATE -w)
  endif()
  set_property(GLOBAL APPEND PROPERTY lrb_worker_programs ${peer_PROGRAM})
  set_property(GLOBAL APPEND PROPERTY lrb_peers_of_${peer_PROGRAM} ${name})
endfunction()

# Bullet in double precision has the symbols of Bullet in single: a separate program.
find_path(LRB_BULLET_INCLUDE btBulletCollisionCommon.h PATH_SUFFIXES bullet DOC "Bullet's headers")
function(lrb_add_bullet name precision program)
  find_library(LRB_BULLET_COLLISION${precision} BulletCollision${precision} DOC "Bullet's collision detection")
  find_library(LRB_BULLET_MATH${precision} LinearMath${precision} DOC "Bullet's linear algebra")
  lrb_need("other engines" libbullet-dev LRB_BULLET_INCLUDE LRB_BULLET_COLLISION${precision} LRB_BULLET_MATH${precision})
  set(libraries "")
  if(LRB_BULLET_INCLUDE AND LRB_BULLET_COLLISION${precision} AND LRB_BULLET_MATH${precision})
    set(libraries ${LRB_BULLET_COLLISION${precision}} ${LRB_BULLET_MATH${precision}})
  endif()
  lrb_add_peer(${name} SOURCE bullet.cpp PROGRAM ${program} HAS LRB_HAS_BULLET LIBRARIES ${libraries})
  if(libraries)
    target_include_directories(lrb_peer_${name} SYSTEM PRIVATE ${LRB_BULLET_INCLUDE})
  endif()
endfunction()
lrb_add_bullet(bullet "" lrbscope-methods)
lrb_add_bullet(bullet_double -float64 lrbscope-methods-double)
target_compile_definitions(lrb_peer_bullet_double PRIVATE BT_USE_DOUBLE_PRECISION)

find_package(CGAL 5.4 QUIET)
lrb_need("other engines" "libcgal-dev (>= 5.4)" CGAL_FOUND)
set(cgal_library "")
if(CGAL_FOUND)
  set(cgal_library CGAL::CGAL)
endif()
foreach(name IN ITEMS cgal cgal_numbers)
  lrb_add_peer(${name} HAS LRB_HAS_CGAL LIBRARIES ${cgal_library})
  target_compile_definitions(lrb_peer_${name} PRIVATE NDEBUG)  # as its manual requires for release builds
endforeach()

find_package(embree 3.13 QUIET)
set(embree_library "")
if(embree_FOUND AND embree_VERSION VERSION_LESS 4)
  set(embree_library embree)
endif()
lrb_need("other engines" "libembree-dev (3)" embree_library)
lrb_add_peer(embree HAS LRB_HAS_EMBREE LIBRARIES ${embree_library})

# FCL as packaged: meshes; and, with its other forms of bodies, an octree and convex hulls.
find_package(fcl 0.7 CONFIG QUIET)
lrb_need("other engines" "libfcl-dev (>= 0.7)" fcl_FOUND)
set(fcl_library "")
if(fcl_FOUND)
  set(fcl_library fcl)
endif()
lrb_add_peer(fcl HAS LRB_HAS_FCL LIBRARIES ${fcl_library})
lrb_add_peer(fcl_solids HAS LRB_HAS_FCL LIBRARIES ${fcl_library})
lrb_add_peer(fcl_numbers HAS LRB_HAS_FCL LIBRARIES ${fcl_library})
if(LRB_NATIVE)  # as packaged, and not half of it for another processor; the file's options come after the target's
  set_source_files_properties(methods/fcl.cpp methods/fcl_solids.cpp PROPERTIES COMPILE_OPTIONS -march=x86-64)
endif()
# FCL built with lrbscope's flags has the symbols of FCL as packaged: a separate program. It instantiates all of FCL for a minute, only
# to measure it for this processor.
if(LRB_NATIVE)
  lrb_add_peer(fcl_headers PROGRAM lrbscope-methods-fcl HAS LRB_HAS_FCL LIBRARIES ${fcl_library})
endif()

find_path(LRB_ODE_INCLUDE ode/ode.h DOC "ODE's headers")
find_library(LRB_ODE ode DOC "ODE")
set(ode_library "")
if(LRB_ODE_INCLUDE AND LRB_ODE)
  set(ode_library ${LRB_ODE})
endif()
lrb_need("other engines" libode-dev ode_library)
lrb_add_peer(ode HAS LRB_HAS_ODE LIBRARIES ${ode_library})

# lrbscope's own methods.
set_property(GLOBAL PROPERTY lrb_own_methods ours plain_double structures own_numbers)
add_library(lrb_own_methods STATIC methods/ours.cpp methods/structures.cpp methods/own_numbers.cpp)
target_link_libraries(lrb_own_methods PUBLIC lrb::methods)

# lrb_register_methods(TARGET [PEER...]): links a program with the methods of the given engines and, unless it
# is one of the further workers, of lrbscope; registered_methods() returns all of them.
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
  lrb_registry(${target} lrb::methods bench/methods/method.hpp MethodEntry methods ${names})
endfunction()

get_property(LRB_WORKER_PROGRAMS GLOBAL PROPERTY lrb_worker_programs)
list(APPEND LRB_WORKER_PROGRAMS lrbscope-methods)
list(REMOVE_DUPLICATES LRB_WORKER_PROGRAMS)
add_library(lrb_worker OBJECT programs/methods.cpp)
target_link_libraries(lrb_worker PUBLIC lrb::quantities lrb::speed)
foreach(program IN LISTS LRB_WORKER_PROGRAMS)
  get_property(names GLOBAL PROPERTY lrb_peers_of_${program})
  add_executable(${program})
  target_link_libraries(${program} PRIVATE lrb_worker)
  lrb_register_methods(${program} ${names})
endforeach()
