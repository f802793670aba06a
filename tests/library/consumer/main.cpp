#include <iostream>
#include <string>

std::string plan_one_robot();

int main() { std::cout << plan_one_robot() << '\n'; }
