# Embree 4 or 3, whichever is found; both name their package and target `embree`.
find_package(embree 4 CONFIG QUIET)
if(NOT embree_FOUND)
  find_package(embree 3 CONFIG REQUIRED)
endif()
get_target_property(embree_file embree LOCATION)  # installed, the file is linked: users need not find Embree
