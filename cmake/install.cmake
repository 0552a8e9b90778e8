# Install rules and the package config that find_package(palpate) finds.
include(CMakePackageConfigHelpers)

install(TARGETS palpate_core palpate_sim palpate_bag palpate_live palpate_ros EXPORT palpateTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
if(PALPATE_BUILD_ROS)
  set(PALPATE_DDS_LIBRARY -lpalpate_dds)
  set(PALPATE_DDS_LINK -lddsc)
  install(TARGETS palpate_dds EXPORT palpateTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
endif()
if(PALPATE_BUILD_VIEWER)
  install(TARGETS palpate_viewer EXPORT palpateTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
endif()
install(DIRECTORY include/palpate DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
# For those who build without CMake: pkg-config --static palpate, where the libraries are static ones.
file(RELATIVE_PATH PALPATE_TO_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/palpate.pc.in palpate.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/palpate.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(EXPORT palpateTargets NAMESPACE palpate:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/palpate)
if(PALPATE_BUILD_APP)
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
endif()

configure_package_config_file(cmake/palpateConfig.cmake.in palpateConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/palpate)
write_basic_package_version_file(palpateConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/palpateConfig.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/palpateConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/palpate)
