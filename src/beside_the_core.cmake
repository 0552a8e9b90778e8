# What is beside and above the core: floors of palpate::core that the core does not see, and further libraries.

if(PALPATE_BUILD_LIVE)
  # palpate::sim: simulated depth cameras, one driver of open_camera(). No public header: tests and benches, which look
  # at what such a camera sees, link it themselves.
  add_library(palpate_sim)
  palpate_library(palpate_sim sim)
  target_include_directories(palpate_sim PRIVATE ${PROJECT_SOURCE_DIR}/src INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>)
  target_link_libraries(palpate_sim PUBLIC palpate_core PRIVATE fmt::fmt)

  # palpate::bag: ROS 2's messages as bytes, and MCAP files of them. No public header, as palpate::sim.
  add_library(palpate_bag)
  palpate_library(palpate_bag bag)
  target_include_directories(palpate_bag PRIVATE ${PROJECT_SOURCE_DIR}/src INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>)
  target_link_libraries(palpate_bag PUBLIC palpate_core PRIVATE fmt::fmt ZLIB::ZLIB PkgConfig::zstd PkgConfig::lz4)

  # palpate::live: what runs beside a device.
  add_library(palpate_live)
  palpate_library(palpate_live live)
  target_include_directories(palpate_live PRIVATE ${PROJECT_SOURCE_DIR}/src)
  find_package(Threads REQUIRED)
  target_link_libraries(palpate_live PUBLIC palpate_core PRIVATE palpate_sim palpate_bag fmt::fmt Threads::Threads)
endif()

# The floors beside it.
add_subdirectory(depth)
add_subdirectory(refine)
add_subdirectory(stream)
add_subdirectory(sight)
add_subdirectory(large)
add_subdirectory(extras)
add_subdirectory(io)
add_subdirectory(align)
if(PALPATE_BUILD_LIVE)
  add_subdirectory(sim)
  add_subdirectory(message)
  add_subdirectory(bag)
  if(PALPATE_BUILD_ROS)
    add_subdirectory(dds)
    target_link_libraries(palpate_live PRIVATE palpate_dds)
  endif()
  add_subdirectory(sensor)
  add_subdirectory(device)
  add_subdirectory(servo)
  add_subdirectory(ros)
  if(PALPATE_BUILD_VIEWER)
    add_subdirectory(viewer)
  endif()
  add_subdirectory(session)
endif()
if(TARGET palpate_viewer OR EMSCRIPTEN)
  add_subdirectory(tab)
endif()
