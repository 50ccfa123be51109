# The workers that put cases to engines of others, found where their Debian packages are installed. They are built
# beside lrbscope, which starts them, and never installed: CGAL's licence is GPL, so nothing of ours may contain it.
find_package(fcl 0.7 CONFIG QUIET)
find_package(CGAL 5.4 QUIET)
find_path(LRB_BULLET_INCLUDE btBulletCollisionCommon.h PATH_SUFFIXES bullet DOC "Bullet's headers")
foreach(precision IN ITEMS "" -float64)
  find_library(LRB_BULLET_COLLISION${precision} BulletCollision${precision} DOC "Bullet's collision detection")
  find_library(LRB_BULLET_MATH${precision} LinearMath${precision} DOC "Bullet's linear algebra")
endforeach()

# An engine of another's in a library of its own, with what that engine wants of the compiler. Its headers are not held
# to our warnings. The rest: what it links to; none if it was not found.
function(lrb_add_peer name source has)
  add_library(${name} STATIC ${source})
  target_link_libraries(${name} PUBLIC lrb::methods PRIVATE ${ARGN})
  if(ARGN)
    target_compile_definitions(${name} PRIVATE ${has})
    target_compile_options(${name} PRIVATE -w)
  endif()
endfunction()

set(fcl_library "")
if(fcl_FOUND)
  set(fcl_library fcl)
endif()
lrb_add_peer(lrb_peer_fcl methods/peers/fcl.cpp LRB_HAS_FCL ${fcl_library})
if(LRB_NATIVE)  # as packaged, and not half of it for another processor; the file's options come after the target's
  set_source_files_properties(methods/peers/fcl.cpp methods/peers/fcl_solids.cpp PROPERTIES COMPILE_OPTIONS -march=x86-64)
endif()
lrb_add_peer(lrb_peer_fcl_headers methods/peers/fcl_headers.cpp LRB_HAS_FCL ${fcl_library})

lrb_add_peer(lrb_peer_fcl_solids methods/peers/fcl_solids.cpp LRB_HAS_FCL ${fcl_library})

find_package(embree 3.13 QUIET)
set(embree_library "")
if(embree_FOUND AND embree_VERSION VERSION_LESS 4)
  set(embree_library embree)
endif()
lrb_add_peer(lrb_peer_embree methods/peers/embree.cpp LRB_HAS_EMBREE ${embree_library})

find_path(LRB_ODE_INCLUDE ode/ode.h DOC "ODE's headers")
find_library(LRB_ODE ode DOC "ODE")
set(ode_library "")
if(LRB_ODE_INCLUDE AND LRB_ODE)
  set(ode_library ${LRB_ODE})
endif()
lrb_add_peer(lrb_peer_ode methods/peers/ode.cpp LRB_HAS_ODE ${ode_library})

set(cgal_library "")
if(CGAL_FOUND)
  set(cgal_library CGAL::CGAL)
endif()
lrb_add_peer(lrb_peer_cgal methods/peers/cgal.cpp LRB_HAS_CGAL ${cgal_library})
target_compile_definitions(lrb_peer_cgal PRIVATE NDEBUG)  # as its manual asks for programs that are not debugged

function(lrb_add_bullet name precision)
  set(libraries "")
  if(LRB_BULLET_INCLUDE AND LRB_BULLET_COLLISION${precision} AND LRB_BULLET_MATH${precision})
    set(libraries ${LRB_BULLET_COLLISION${precision}} ${LRB_BULLET_MATH${precision}})
  endif()
  lrb_add_peer(${name} methods/peers/bullet.cpp LRB_HAS_BULLET ${libraries})
  if(libraries)
    target_include_directories(${name} SYSTEM PRIVATE ${LRB_BULLET_INCLUDE})
  endif()
endfunction()
lrb_add_bullet(lrb_peer_bullet "")
lrb_add_bullet(lrb_peer_bullet_double -float64)
target_compile_definitions(lrb_peer_bullet_double PRIVATE BT_USE_DOUBLE_PRECISION)

add_library(lrb_worker_programs STATIC worker_programs/fake_methods.cpp worker_programs/worker.cpp)
target_link_libraries(lrb_worker_programs PUBLIC lrb::stability lrb::bench CLI11::CLI11 lrb_options)

add_executable(lrbscope-methods worker_programs/worker_main.cpp)
target_link_libraries(lrbscope-methods PRIVATE lrb_worker_programs lrb_peer_fcl lrb_peer_cgal lrb_peer_bullet lrb_peer_embree
                                               lrb_peer_fcl_solids lrb_peer_ode)
# Bullet in double precision has the names of Bullet in single: a program of its own.
add_executable(lrbscope-methods-double worker_programs/worker_double_main.cpp)
target_link_libraries(lrbscope-methods-double PRIVATE lrb_worker_programs lrb_peer_bullet_double)
# FCL with our flags has the names of FCL as packaged: one, too.
add_executable(lrbscope-methods-fcl worker_programs/worker_fcl_main.cpp)
target_link_libraries(lrbscope-methods-fcl PRIVATE lrb_worker_programs lrb_peer_fcl_headers)
