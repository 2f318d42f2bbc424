#pragma once

/// Windows' header, which TBB includes, without its macros of common names. Precompiled before all
/// other headers (cpp/cmake/quick_build.cmake).
#include <windows.h>
#undef far
#undef near
#undef interface
#undef small
