#pragma once
#include <pthread.h>

namespace limn {

/// Names the calling thread for debuggers and `top`, and the threads it starts from now on. At most 15 characters.
inline void nameThread(const char* name) { pthread_setname_np(pthread_self(), name); }

}  // namespace limn
