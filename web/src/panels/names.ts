/** The thing's own name, or what it is with its place in the list. */
export const nameOf = (name: string | undefined, what: string, index: number): string =>
  name || `${what} #${index}`.trim();
