/** Whether the server refuses the token: a WebSocket does not reveal why it failed. */

export async function loginRefusal(address: string, query: string): Promise<string> {
  const page = address.replace(/^ws/, "http");
  if (page !== location.origin) return ""; // another server; its answer is not readable
  const response = await fetch(`${page}/health${query}`).catch(() => null);
  if (response?.status === 429) return (await response.text()).trim();
  if (response?.status !== 401) return "";
  return query ? "This token is not valid: a new run has a new token." : "A token is required: use the address that the program prints.";
}
