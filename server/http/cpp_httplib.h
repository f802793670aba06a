#pragma once

// Include cpp-httplib by this name only. It includes <resolv.h>, whose macro `_res` breaks the headers
// of Eigen if they are included later.

#include <httplib.h>

#undef _res
