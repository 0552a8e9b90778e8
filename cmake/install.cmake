# Install rules and the package config that find_package(palpate) finds.
include(CMakePackageConfigHelpers)

set(libraries palpate_core palpate_sim palpate_bag palpate_live palpate_ros)
if(PALPATE_BUILD_ROS)
  set(PALPATE_DDS_LIBRARY -lpalpate_dds)
  set(PALPATE_DDS_LINK -lddsc)
  list(APPEND libraries palpate_dds)
endif()
if(PALPATE_BUILD_VIEWER)
  set(PALPATE_VIEWER_LIBRARY -lpalpate_viewer)
  list(APPEND libraries palpate_viewer)
endif()
install(TARGETS ${libraries} EXPORT palpateTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY include/palpate DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT palpateTargets NAMESPACE palpate:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/palpate)

# What static libraries are made with, those who link them need, too, whether or not they ask pkg-config for --static.
set(PALPATE_SHARED OFF)
if(BUILD_SHARED_LIBS)
  set(PALPATE_SHARED ON)
else()
  set(PALPATE_STATIC_MODULES "tbb fmt zlib spng pugixml libbrotlidec libzstd liblz4 tomlplusplus")
  set(PALPATE_STATIC_LIBRARIES "-lstdc++ -pthread -ldl ${PALPATE_DRIVER_LIBRARIES} ${PALPATE_DDS_LINK}")
endif()
file(RELATIVE_PATH PALPATE_TO_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/palpate.pc.in palpate.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/palpate.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
configure_package_config_file(cmake/palpateConfig.cmake.in palpateConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/palpate)
write_basic_package_version_file(palpateConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/palpateConfig.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/palpateConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/palpate)

# The licences, those of what is compiled in among them, and the documents with their images.
install(FILES packaging/debian/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN *.md PATTERN images/*)
if(NOT PALPATE_BUILD_APP)
  return()
endif()
file(RELATIVE_PATH to_libraries /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR})
set_target_properties(palpate_app PROPERTIES INSTALL_RPATH $ORIGIN/${to_libraries})
install(TARGETS palpate_app RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
if(NOT CMAKE_CROSSCOMPILING)
  set(texts ${CMAKE_CURRENT_BINARY_DIR}/apps/palpate)
  install(FILES ${texts}/palpate.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  install(FILES ${texts}/palpate.bash RENAME palpate
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
endif()
install(FILES packaging/60-palpate.rules packaging/palpate-limits.conf
  DESTINATION ${CMAKE_INSTALL_DATADIR}/palpate)
install(FILES packaging/palpate.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications)
install(FILES packaging/palpate.metainfo.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/metainfo)
install(FILES packaging/palpate.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps)
