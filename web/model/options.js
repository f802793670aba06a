// The options of a plan as a person sets them, and editing them in a request. Pure.

/** Each option of /v1/plan: its default, how it is set, its unit, and what it does. */
export const OPTIONS = [
  {
    name: "mode",
    label: "Mode",
    default: "first",
    choices: { first: "First solution", anytime: "Improve until the budget ends" },
    help: "First returns as soon as every robot has a plan; improving uses the whole time budget.",
  },
  {
    name: "objective",
    label: "Objective",
    default: "flowtime",
    choices: { flowtime: "Flowtime (sum)", makespan: "Makespan (last)" },
    help: "What improving lowers: the sum of all arrival times, or the last one.",
  },
  {
    name: "time_budget_ms",
    label: "Time budget",
    unit: "ms",
    default: null, // the service's, see GET /v1/limits
    unset: "the service's, 5000 ms as a rule",
    min: 1,
    step: 1,
    integer: true,
    help: "How long the service may take, waiting in its queue included.",
  },
  {
    name: "max_iterations",
    label: "Improvement steps",
    default: null,
    unset: "by the clock",
    min: 0,
    step: 1,
    integer: true,
    help: "Ends improving after so many steps instead of by the clock: the same plan each time.",
  },
  {
    name: "priority",
    label: "First order",
    default: "shortest_first",
    choices: {
      shortest_first: "Shortest way first",
      longest_first: "Longest way first",
      as_listed: "As listed",
      random: "Random",
    },
    help: "In which order robots are planned at first; later ones yield to earlier ones.",
  },
  {
    name: "reordering",
    label: "When one fails",
    default: "raise_failed",
    choices: { raise_failed: "Plan it first", random: "Shuffle", none: "Go on without it" },
    help: "What changes in the order when a robot finds no way.",
  },
  {
    name: "seed",
    label: "Seed",
    default: 0,
    min: 0,
    step: 1,
    integer: true,
    help: "The same request and seed give the same plan.",
  },
  {
    name: "start_safe_interval",
    label: "Start safe interval",
    unit: "s",
    default: 3,
    min: 0,
    step: 0.5,
    help: "How long others keep clear of a robot's start, so that it can get away.",
  },
  {
    name: "inflation",
    label: "Inflation",
    unit: "m",
    default: 0,
    min: 0,
    step: 0.01,
    help: "Added to every radius while planning: room for errors of motion.",
  },
  {
    name: "wait_before_move",
    label: "Wait before a move",
    unit: "s",
    default: 0,
    min: 0,
    step: 0.1,
    help: "Robots stand still at least so long before each translation.",
  },
  {
    name: "any_angle",
    label: "Any angle",
    default: true,
    help: "Straight moves in any direction; else only along the grid's edges.",
  },
  {
    name: "connectivity",
    label: "Connectivity",
    default: 8,
    choices: { 4: "4 neighbours", 8: "8 neighbours", 16: "16 neighbours", 32: "32 neighbours" },
    integer: true,
    help: "How many neighbours a cell has in the search.",
  },
];

/** The value of an option in a request: its own or the default. */
export function optionOf(request, option) {
  return request?.options?.[option.name] ?? option.default;
}

/** The request with an option set; the default is left out, and options that are all left out. */
export function withOption(request, option, value) {
  const options = { ...request.options, [option.name]: value };
  if (value === option.default) delete options[option.name];
  const edited = { ...request, options };
  if (Object.keys(options).length === 0) delete edited.options;
  return edited;
}
