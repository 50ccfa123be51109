# FCL as packaged: meshes; and, with its other forms of bodies, an octree and convex hulls.
find_package(fcl 0.7 CONFIG QUIET)
lrb_need("other engines" "libfcl-dev (>= 0.7)" fcl_FOUND)
set(fcl_library "")
if(fcl_FOUND)
  set(fcl_library fcl)
endif()
lrb_add_peer(fcl HAS LRB_HAS_FCL LIBRARIES ${fcl_library})
lrb_add_peer(fcl_solids HAS LRB_HAS_FCL LIBRARIES ${fcl_library})
if(LRB_NATIVE)  # as packaged, and not half of it for another processor; the file's options come after the target's
  set_source_files_properties(methods/peers/fcl.cpp methods/peers/fcl_solids.cpp PROPERTIES COMPILE_OPTIONS -march=x86-64)
endif()
# FCL with our flags has the names of FCL as packaged: a program of its own.
lrb_add_peer(fcl_headers PROGRAM lrbscope-methods-fcl HAS LRB_HAS_FCL LIBRARIES ${fcl_library})
