#pragma once

// Include cpp-httplib only by this header. cpp-httplib includes <resolv.h>, whose macro `_res` breaks the
// headers of Eigen if they are included later.

#include <httplib.h>

#undef _res
