# What `cmake --install` gives: the program, the libraries with their public headers, and the package for find_package(cambium).
include(CMakePackageConfigHelpers)

set(public_headers
  blobtree/blobtree.h blobtree/blobtree_json.h blobtree/cell_grid.h blobtree/cell_search.h blobtree/field.h blobtree/geometry.h
  blobtree/id_table.h blobtree/input_error.h blobtree/invalid_node.h blobtree/node_store.h blobtree/nodes.h blobtree/run_options.h
  blobtree/box_tree.h blobtree/branch_info.h blobtree/choices.h blobtree/float_box.h blobtree/place_hash.h blobtree/sheet.h
  blobtree/surface_cover.h
  skeletons/foliage.h skeletons/skeleton.h skeletons/skeleton_io.h skeletons/surface.h skeletons/surface_roots.h skeletons/trunk_base.h
  skeletons/graph/closed_mesh.h skeletons/graph/edge_weights.h skeletons/graph/graph_volume.h skeletons/graph/node_graph.h
  skeletons/graph/plan.h skeletons/graph/prepared_solid.h skeletons/graph/refinement.h skeletons/graph/settled_cells.h skeletons/graph/solids.h
  skeletons/graph/svg_path.h
  lsystem/dialect.h lsystem/growth.h lsystem/growth_parts.h lsystem/lsystem.h
  polygonize/ambient_occlusion.h polygonize/decimate.h polygonize/mesh.h polygonize/mesh_attributes.h polygonize/mesh_io.h
  polygonize/mesh_read.h polygonize/polygonize.h polygonize/verify.h polygonize/volume.h polygonize/volume_read.h
  raytrace/aov.h raytrace/bark.h raytrace/bark_noise.h raytrace/bark_number.h raytrace/bark_pattern.h raytrace/camera.h
  raytrace/environment.h raytrace/film.h raytrace/foliage_scene.h raytrace/foliage_texture.h raytrace/image_file.h raytrace/light.h raytrace/path_options.h
  raytrace/pixel_rect.h raytrace/render.h raytrace/sampling.h raytrace/texture_image.h)
foreach(header ${public_headers})
  get_filename_component(folder ${header} DIRECTORY)
  install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/cambium/${folder})
endforeach()

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/cambium)
foreach(folder blobtree skeletons lsystem polygonize raytrace)
  install(TARGETS cambium_${folder} EXPORT cambium-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
                                                           LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
endforeach()
install(TARGETS cambium_image_codec LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT cambium-targets NAMESPACE cambium:: DESTINATION ${package_dir})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/cambium-config.cmake.in ${PROJECT_BINARY_DIR}/cambium-config.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/cambium-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/cambium-config.cmake ${PROJECT_BINARY_DIR}/cambium-config-version.cmake
        DESTINATION ${package_dir})
