#pragma once

// The HTTP library, to be included by this name only. It brings <resolv.h>, whose macro `_res` breaks the
// headers of Eigen when they come after it.

#include <httplib.h>

#undef _res
