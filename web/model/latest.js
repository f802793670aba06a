// Work for the present request, which a newer one replaces. No DOM.

/**
 * A function (delay, work) that calls work(signal) after a delay in milliseconds. Another call drops earlier work: it
 * is not begun any more, or its signal is aborted. Then its AbortError is ignored.
 */
export function latestOnly() {
  let timer = null;
  let control = new AbortController();
  return (delay, work) => {
    clearTimeout(timer);
    control.abort();
    control = new AbortController();
    const { signal } = control;
    timer = setTimeout(async () => {
      try {
        await work(signal);
      } catch (error) {
        if (!signal.aborted) throw error;
      }
    }, delay);
  };
}

/** Lets the browser paint and answer people before long work goes on. */
export const nextTask = () => new Promise((resolve) => setTimeout(resolve));
