#include "server/daemon/daemon.hpp"

int main(int argc, char** argv) { return limn::server::runDaemon({argv + 1, argv + argc}); }
