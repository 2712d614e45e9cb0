# cmake -DSOURCE=... -DBUILD=... -P core_only_build.cmake
#
# Core builds where gRPC and Protobuf cannot be found. Not optimised: whether it
# compiles is the question.
foreach(command
    "--preset;core-only;-B;${BUILD};-DCMAKE_BUILD_TYPE=Debug;\
-DCMAKE_CXX_FLAGS_DEBUG=-O0;-DCMAKE_DISABLE_FIND_PACKAGE_gRPC=ON;\
-DCMAKE_DISABLE_FIND_PACKAGE_Protobuf=ON"
    "--build;${BUILD};--parallel;2")
  execute_process(COMMAND ${CMAKE_COMMAND} ${command}
    WORKING_DIRECTORY ${SOURCE} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
