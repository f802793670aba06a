// The options of a plan by what they are for, and what each costs, in a few words. Options that are not named here, as of
// a newer service, are for experts.

export const OPTION_GROUPS = {
  Safety: {
    inflation: "Costs room: narrow aisles may close.",
    interval_margin: "Costs time: robots wait longer for each other.",
    start_safe_interval: "Costs time at the beginning, where starts are near to each other.",
    wait_before_move: "Costs this time before every drive.",
    execution_margin: "Costs waits while the plan is executed.",
    dependency_slack: "Costs little: robots on time are told to go on a little earlier.",
  },
  Time: {
    time_budget_ms: "More time gives better plans; the answer comes later.",
    mode: "“Anytime” uses the whole time budget.",
    max_iterations: "More steps give better plans; the answer comes later.",
    horizon: "A short horizon plans faster, and may end before the goals.",
  },
  Quality: {
    objective: "Costs nothing: it says what a good plan is.",
    any_angle: "Straight ways are shorter, and take longer to plan.",
    smoothing: "Shorter paths take longer to plan.",
    connectivity: "More neighbours give shorter paths, and take longer to plan.",
    replan: "Keeping plans is faster, and may leave better ones unfound.",
  },
  Expert: {},
};

/** The options in their groups: [{title, options: [{option, cost}]}]; groups without options are left out. */
export function grouped(options) {
  const titleOf = ({ name }) =>
    Object.keys(OPTION_GROUPS).find((title) => Object.hasOwn(OPTION_GROUPS[title], name)) ?? "Expert";
  const groups = Object.keys(OPTION_GROUPS).map((title) => ({
    title,
    options: options
      .filter((option) => titleOf(option) === title)
      .map((option) => ({ option, cost: OPTION_GROUPS[title][option.name] ?? "" })),
  }));
  return groups.filter((group) => group.options.length > 0);
}
