find_package(CGAL 5.4 QUIET)
lrb_need("other engines" "libcgal-dev (>= 5.4)" CGAL_FOUND)
set(cgal_library "")
if(CGAL_FOUND)
  set(cgal_library CGAL::CGAL)
endif()
lrb_add_peer(cgal HAS LRB_HAS_CGAL LIBRARIES ${cgal_library})
target_compile_definitions(lrb_peer_cgal PRIVATE NDEBUG)  # as its manual asks for programs that are not debugged
