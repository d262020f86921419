#include "server/limn/commands.hpp"

int main(int count, char** words) { return limn::runLimn({words + 1, words + count}); }
